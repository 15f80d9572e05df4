// RoundTrip LOG: as round_trip.cpp does, with the classes for Java.
import java.io.BufferedInputStream;
import java.io.DataInputStream;
import java.io.EOFException;
import java.io.FileInputStream;
import java.nio.charset.StandardCharsets;
import java.util.Arrays;
import java.util.Map;
import java.util.TreeMap;
import lcm.lcm.LCMDataOutputStream;
import lcm.lcm.LCMEncodable;

public final class RoundTrip {
  private RoundTrip() {}

  private static LCMEncodable decode(String channel, byte[] body) throws java.io.IOException {
    switch (channel) {
      case "PLIANT_POSE": return new bot_core.rigid_transform_t(body);
      case "PLIANT_REGIONS": return new pliant.regions_t(body);
      case "PLIANT_DEFORMED": return new pliant.deformed_t(body);
      case "PLIANT_STATUS": return new pliant.status_t(body);
      case "PLIANT_DEPTH": return new pliant.depth_t(body);
      case "PLIANT_MODEL": return new pliant.model_t(body);
      default: return null;
    }
  }

  public static void main(String[] words) throws Exception {
    Map<String, Integer> counts = new TreeMap<>();
    try (DataInputStream in = new DataInputStream(new BufferedInputStream(new FileInputStream(words[0])))) {
      while (true) {
        in.readInt();
        in.readLong();
        in.readLong();
        byte[] channel = new byte[in.readInt()];
        byte[] body = new byte[in.readInt()];
        in.readFully(channel);
        in.readFully(body);
        String name = new String(channel, StandardCharsets.US_ASCII);
        LCMEncodable message = decode(name, body);
        if (message == null) continue;
        LCMDataOutputStream out = new LCMDataOutputStream();
        message.encode(out);
        if (!Arrays.equals(Arrays.copyOf(out.getBuffer(), out.size()), body)) {
          System.out.println(name + " differs");
          System.exit(1);
        }
        counts.merge(name, 1, Integer::sum);
      }
    } catch (EOFException end) {
      counts.forEach((name, count) -> System.out.println(name + " " + count));
    }
  }
}
