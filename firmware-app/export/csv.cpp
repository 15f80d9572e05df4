#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <span>

#include "drivers/geometry_files/atomic_file.hpp"
#include "firmware-app/export/exporters.hpp"
#include "firmware-app/outputs/status_counts.hpp"
#include "firmware-app/outputs/words.hpp"

namespace pliant {

namespace {

/// One table, which appears when it is finished; the first failure stays and shows there.
class Table {
 public:
  Outcome open(const std::string& path, const std::string& columns) {
    if (Outcome opened = file_.open(path.c_str()); !opened) return opened;
    row(columns);
    return success();
  }
  void row(const std::string& text) {
    text_.append(text).append("\n");
    ++rows_;
    if (text_.size() >= kAtOnce) flush();
  }
  Outcome finish() {
    flush();
    return state_ ? file_.commit(false) : state_;
  }
  [[nodiscard]] std::int64_t rows() const { return rows_ - 1; }

 private:
  static constexpr std::size_t kAtOnce = 1U << 16;
  void flush() {
    if (state_) state_ = file_.write(std::as_bytes(std::span(text_)));
    text_.clear();
  }
  AtomicFile file_;
  std::string text_;
  Outcome state_ = success();
  std::int64_t rows_ = 0;
};

/// A field with quotes where it needs them.
std::string quoted(const std::string& text) {
  if (text.find_first_of("\",\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string transform(const std::array<double, 3>& t, const std::array<double, 4>& q) {
  return fmt::format("{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", t[0], t[1], t[2], q[0], q[1], q[2],
                     q[3]);
}

/// Empty where a region does not touch its parent.
std::string joint_of(const RegionMessage& region) {
  if (!region.joint) return ",,";
  return fmt::format("{:.7g},{:.7g},{:.7g}", region.joint->x, region.joint->y, region.joint->z);
}

class CsvExporter final : public LogExporter {
 public:
  explicit CsvExporter(std::string folder) : folder_(std::move(folder)) {}

  Outcome open() {
    const auto path = [&](const char* name) { return folder_ + "/" + name; };
    if (Outcome opened = frames_.open(path("frames.csv"),
                                      "utime,frame,state,confidence,regions,deformed,not_observed,"
                                      "max_displacement_m,tx,ty,tz,qw,qx,qy,qz");
        !opened)
      return opened;
    if (Outcome opened = regions_.open(path("regions.csv"),
                                       "utime,frame,region,parent,points,rms_m,confidence,"
                                       "tx,ty,tz,qw,qx,qy,qz,joint_x,joint_y,joint_z");
        !opened)
      return opened;
    if (Outcome opened = deformed_.open(path("deformed.csv"), "utime,frame,point,x,y,z,dx,dy,dz,strain");
        !opened)
      return opened;
    std::string columns =
        "utime,version,source,frame,state,device,stream_fault,rate_hz,strain_energy,latency_median_us,"
        "latency_p99_us,"
        "latency_max_us";
    for (const NamedCount& about : kStatusCounts) columns += std::string(",") + about.name;
    if (Outcome opened = status_.open(path("status.csv"), columns + ",last_error"); !opened) return opened;
    return stages_.open(path("stages.csv"), "utime,stage,median_us,p99_us,max_us");
  }

  Outcome frame(std::int64_t /*received_us*/, const ReceivedFrame& frame, const ReceivedModel* /*model*/,
                std::span<const Point3f> /*positions*/) override {
    float most = 0;
    for (const Point3f& d : frame.displacement) most = std::max(most, std::hypot(d.x, d.y, d.z));
    const bool base = !frame.regions.empty() && frame.regions.front().id == 0;
    frames_.row(fmt::format(
        "{},{},{},{:.6g},{},{},{},{:.6g},{}", frame.utime, frame.frame, state_word(frame.state),
        frame.confidence, frame.regions.size(), frame.deformed.size(),
        std::count(frame.labels.begin(), frame.labels.end(), kNotObserved), most,
        base ? transform(frame.regions.front().trans, frame.regions.front().quat) : std::string(",,,,,,")));
    for (const RegionMessage& r : frame.regions)
      regions_.row(fmt::format("{},{},{},{},{},{:.6g},{:.6g},{},{}", frame.utime, frame.frame, r.id, r.parent,
                               r.points, r.rms, r.confidence, transform(r.trans, r.quat), joint_of(r)));
    for (std::size_t i = 0; i < frame.deformed.size(); ++i) {
      const Point3f& p = frame.position[i];
      const Point3f& d = frame.displacement[i];
      deformed_.row(fmt::format("{},{},{},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.6g}", frame.utime,
                                frame.frame, frame.deformed[i], p.x, p.y, p.z, d.x, d.y, d.z,
                                frame.strain[i]));
    }
    return success();
  }

  Outcome status(std::int64_t /*received_us*/, const StatusMessage& s) override {
    std::string counts;
    for (const NamedCount& about : kStatusCounts) counts += fmt::format(",{}", s.*about.count);
    status_.row(fmt::format("{},{},{},{},{},{},{},{:.6g},{:.6g},{},{},{}{},{}", s.utime, quoted(s.version),
                            quoted(s.source), s.frame, state_word(s.state), name_of(s.device),
                            name_of(s.stream_fault), s.rate, s.strain_energy, s.latency_median, s.latency_p99,
                            s.latency_max, counts, quoted(s.last_error)));
    for (const StageMessage& stage : s.stages)
      stages_.row(
          fmt::format("{},{},{},{},{}", s.utime, quoted(stage.name), stage.median, stage.p99, stage.max));
    return success();
  }

  Outcome finish() override {
    for (Table* table : {&frames_, &regions_, &deformed_, &status_, &stages_})
      if (Outcome done = table->finish(); !done) return done;
    return success();
  }
  [[nodiscard]] std::string summary() const override {
    return fmt::format("{} frames and {} statuses as tables in {}", frames_.rows(), status_.rows(), folder_);
  }

 private:
  std::string folder_;
  Table frames_, regions_, deformed_, status_, stages_;
};

}  // namespace

Result<std::unique_ptr<LogExporter>> export_csv(const std::string& folder) {
  std::error_code fault;
  std::filesystem::create_directories(folder, fault);
  if (fault)
    return Error{ErrorKind::write, fmt::format("cannot make the folder {}: {}", folder, fault.message())};
  auto exporter = std::make_unique<CsvExporter>(folder);
  if (const Outcome opened = exporter->open(); !opened) return opened.error();
  return std::unique_ptr<LogExporter>(std::move(exporter));
}

}  // namespace pliant
