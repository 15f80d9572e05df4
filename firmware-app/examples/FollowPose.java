// Follows the object: prints where it is in each frame. Packages: liblcm-java, liblcm-bin, default-jdk-headless.
//   lcm-gen --java --jpath out/java drivers/lcm/types/*.lcm
//   javac -cp /usr/share/java/lcm.jar -d out/java $(find out/java -name '*.java') firmware-app/examples/FollowPose.java
//   java -cp /usr/share/java/lcm.jar:out/java FollowPose [URL] [PREFIX]
import bot_core.rigid_transform_t;
import java.util.Locale;
import lcm.lcm.LCM;

public final class FollowPose {
  private FollowPose() {}

  public static void main(String[] words) throws Exception {
    String url = words.length > 0 ? words[0] : "udpm://239.255.76.67:7667?ttl=0";
    String prefix = words.length > 1 ? words[1] : "PLIANT";
    LCM bus = new LCM(url);
    bus.subscribe(prefix + "_POSE", (lcm, channel, in) -> {
      try {
        rigid_transform_t m = new rigid_transform_t(in);
        // A point of the model is in the camera's frame at R(quat) * point + trans; metres.
        System.out.printf(Locale.ROOT, "%d %.6f %.6f %.6f  %.6f %.6f %.6f %.6f%n", m.utime, m.trans[0], m.trans[1],
            m.trans[2], m.quat[0], m.quat[1], m.quat[2], m.quat[3]);
      } catch (java.io.IOException fault) {
        System.err.println(channel + ": " + fault.getMessage());
      }
    });
    Thread.currentThread().join();
  }
}
