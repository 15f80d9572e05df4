// Lists the points that moved more than a threshold: ListDeformed MILLIMETRES [URL] [PREFIX]
// Compiled like FollowPose.java.
import java.util.Locale;
import lcm.lcm.LCM;
import pliant.deformed_t;

public final class ListDeformed {
  private ListDeformed() {}

  public static void main(String[] words) throws Exception {
    if (words.length < 1) {
      System.err.println("ListDeformed MILLIMETRES [URL] [PREFIX]");
      System.exit(2);
    }
    double threshold = Double.parseDouble(words[0]) / 1000;
    String url = words.length > 1 ? words[1] : "udpm://239.255.76.67:7667?ttl=0";
    String prefix = words.length > 2 ? words[2] : "PLIANT";
    LCM bus = new LCM(url);
    bus.subscribe(prefix + "_DEFORMED", (lcm, channel, in) -> {
      try {
        deformed_t m = new deformed_t(in); // each part of a frame's points can be used by itself
        for (int i = 0; i < m.num_points; ++i) {
          float[] d = m.displacement[i];
          double length = Math.sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
          if (length > threshold) {
            float[] p = m.position[i];
            System.out.printf(Locale.ROOT, "%d %d %.2f  %.6f %.6f %.6f%n", m.frame, m.index[i], 1000 * length, p[0],
                p[1], p[2]);
          }
        }
      } catch (java.io.IOException fault) {
        System.err.println(channel + ": " + fault.getMessage());
      }
    });
    Thread.currentThread().join();
  }
}
