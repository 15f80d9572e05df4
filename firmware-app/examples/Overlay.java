// Drives an overlay: draws the tracked points over a camera's picture, into an image file that is replaced with each
// frame. Overlay OUT.ppm WIDTH HEIGHT FX FY CX CY [URL] [PREFIX]; the camera as `pliant record` writes it. Compiled
// like FollowPose.java.
import java.io.IOException;
import java.nio.charset.StandardCharsets;
import java.nio.file.Files;
import java.nio.file.Path;
import java.nio.file.StandardCopyOption;
import java.util.HashMap;
import java.util.Map;
import lcm.lcm.LCM;
import lcm.lcm.LCMDataInputStream;
import pliant.deformed_t;
import pliant.model_t;
import pliant.region_t;
import pliant.regions_t;

public final class Overlay {
  private static final int[] BLUE = {0, 114, 178}, YELLOW = {240, 228, 66}, RED = {213, 94, 0};

  private final Path file;
  private final int width, height;
  private final double[] camera; // fx, fy, cx, cy
  private final String prefix;
  private double[][] rest = {};
  private byte[] picture;

  private Overlay(Path file, int width, int height, double[] camera, String prefix) {
    this.file = file;
    this.width = width;
    this.height = height;
    this.camera = camera;
    this.prefix = prefix;
    picture = new byte[3 * width * height];
  }

  /** R(quat) * p + trans. */
  private static double[] move(region_t r, double[] p) {
    double w = r.quat[0], x = r.quat[1], y = r.quat[2], z = r.quat[3];
    return new double[] {
      (1 - 2 * (y * y + z * z)) * p[0] + 2 * (x * y - w * z) * p[1] + 2 * (x * z + w * y) * p[2] + r.trans[0],
      2 * (x * y + w * z) * p[0] + (1 - 2 * (x * x + z * z)) * p[1] + 2 * (y * z - w * x) * p[2] + r.trans[1],
      2 * (x * z - w * y) * p[0] + 2 * (y * z + w * x) * p[1] + (1 - 2 * (x * x + y * y)) * p[2] + r.trans[2]
    };
  }

  private void draw(double x, double y, double z, int[] colour) {
    if (!(z > 0)) return;
    long u = Math.round(camera[0] * x / z + camera[2]);
    long v = Math.round(camera[1] * y / z + camera[3]);
    if (u < 0 || v < 0 || u >= width || v >= height) return;
    int at = (int) (3 * (v * width + u));
    for (int k = 0; k < 3; ++k) picture[at + k] = (byte) colour[k];
  }

  /** The frame that is done; the file is never seen half written. */
  private void show() throws IOException {
    byte[] head = ("P6 " + width + " " + height + " 255\n").getBytes(StandardCharsets.US_ASCII);
    byte[] all = new byte[head.length + picture.length];
    System.arraycopy(head, 0, all, 0, head.length);
    System.arraycopy(picture, 0, all, head.length, picture.length);
    Path part = file.resolveSibling(file.getFileName() + ".part");
    Files.write(part, all);
    Files.move(part, file, StandardCopyOption.ATOMIC_MOVE, StandardCopyOption.REPLACE_EXISTING);
    picture = new byte[picture.length];
  }

  /** The model comes in parts, again and again: each is kept. */
  private void model(model_t m) {
    if (rest.length != m.model_points) rest = new double[m.model_points][3];
    for (int i = 0; i < m.num_points; ++i)
      for (int k = 0; k < 3; ++k) rest[m.first_point + i][k] = m.origin[k] + m.step * m.position[i][k];
  }

  /** Points of rigid regions lie where their region carries them. */
  private void regions(regions_t m) throws IOException {
    if (m.first_point == 0) show();
    Map<Integer, region_t> byId = new HashMap<>();
    for (region_t region : m.regions) byId.put((int) region.id, region);
    for (int i = 0; i < m.num_labels; ++i) {
      region_t region = byId.get((int) m.labels[i]);
      if (region == null || m.first_point + i >= rest.length) continue;
      double[] p = move(region, rest[m.first_point + i]);
      draw(p[0], p[1], p[2], region.id == 0 ? BLUE : YELLOW);
    }
  }

  /** Deformed ones are sent with their positions. */
  private void deformed(deformed_t m) {
    for (float[] p : m.position) draw(p[0], p[1], p[2], RED);
  }

  private void received(LCM bus, String channel, LCMDataInputStream in) {
    try {
      if (channel.equals(prefix + "_MODEL")) model(new model_t(in));
      if (channel.equals(prefix + "_REGIONS")) regions(new regions_t(in));
      if (channel.equals(prefix + "_DEFORMED")) deformed(new deformed_t(in));
    } catch (IOException fault) {
      System.err.println(channel + ": " + fault.getMessage());
    }
  }

  public static void main(String[] words) throws Exception {
    if (words.length < 7) {
      System.err.println("Overlay OUT.ppm WIDTH HEIGHT FX FY CX CY [URL] [PREFIX]");
      System.exit(2);
    }
    double[] camera = new double[4];
    for (int i = 0; i < 4; ++i) camera[i] = Double.parseDouble(words[3 + i]);
    String prefix = words.length > 8 ? words[8] : "PLIANT";
    Overlay overlay = new Overlay(Path.of(words[0]), Integer.parseInt(words[1]), Integer.parseInt(words[2]), camera,
        prefix);
    LCM bus = new LCM(words.length > 7 ? words[7] : "udpm://239.255.76.67:7667?ttl=0");
    for (String kind : new String[] {"MODEL", "REGIONS", "DEFORMED"})
      bus.subscribe(prefix + "_" + kind, overlay::received);
    Thread.currentThread().join();
  }
}
