#include "ayumi/io/formats/op3_action.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "ayumi/base/counted.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi {

namespace {

// Definition: action_file_define.h of ROBOTIS-OP3.
constexpr size_t kPages = 256, kSteps = 7, kServos = 31, kPageBytes = 512, kStepBytes = 64;
constexpr size_t kStepCount = 20, kSpeed = 22, kNext = 25, kExit = 26, kChecksum = 31;
constexpr size_t kNameBytes = 13, kAccel = 24, kSchedule = 16, kRepeat = 15, kGain = 32;
constexpr int kNotUsed = 0x4000, kTorqueOff = 0x2000, kZero = 2048;
constexpr unsigned char kUsualSpeed = 32;
constexpr double kTick = 0.008;              // time of a tick [s]
constexpr double kCount = EIGEN_PI / kZero;  // angle of a count [rad]
// Duration of a page with one posture [s]. Chosen: long enough to be judged, in units of 8 ms.
constexpr double kHeld = 0.8;
// Largest number of damaged pages that a note names. Chosen: they fit on a line.
constexpr size_t kNamedPages = 5;

size_t byte_at(const std::string& bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}

size_t checksum_of(const std::string& bytes, size_t page) {
  size_t sum = 0;
  for (size_t i = 0; i < kPageBytes; ++i)
    if (i != kChecksum) sum += byte_at(bytes, page * kPageBytes + i);
  return (0xff - sum) & 0xff;
}

std::string page_name(const std::string& bytes, size_t page) {
  std::string name;
  for (size_t i = 0; i < kNameBytes; ++i) {
    const char c = bytes[page * kPageBytes + i];
    if (c < 32 || c > 126) break;
    name += c;
  }
  return name;
}

bool is_sound(const std::string& bytes, size_t page) {
  const size_t steps = byte_at(bytes, page * kPageBytes + kStepCount);
  return steps > 0 && steps <= kSteps &&
         byte_at(bytes, page * kPageBytes + kChecksum) == checksum_of(bytes, page);
}

int position_at(const std::string& bytes, size_t step, size_t servo) {
  return static_cast<int>(byte_at(bytes, step + 2 * servo) | byte_at(bytes, step + 2 * servo + 1)
                                                                 << 8);
}

}  // namespace

std::string recognize_op3_action(const MotionInput& source) {
  const std::string& bytes = source.bytes;
  if (bytes.find('\0') == std::string::npos) return "";
  if (bytes.size() == kPages * kPageBytes) return "the file has 256 pages of 512 bytes";
  // If a file was cut off, or continues after its pages, every whole page is either sound or empty.
  size_t sound = 0, others = 0;
  for (size_t page = 0; (page + 1) * kPageBytes <= std::min(bytes.size(), kPages * kPageBytes);
       ++page) {
    if (is_sound(bytes, page))
      sound += page_name(bytes, page).empty() ? 0 : 1;
    else if (byte_at(bytes, page * kPageBytes + kStepCount) > 0)
      ++others;
  }
  return sound > 0 && others == 0 ? "the file has pages of 512 bytes with steps and their checksums"
                                  : "";
}

MotionFile read_op3_action(const MotionInput& source) {
  const std::string& bytes = source.bytes;
  if (bytes.size() != kPages * kPageBytes)
    source.refuse(0, "the file has " + std::to_string(bytes.size()) +
                         " bytes, but an action file has " + std::to_string(kPages * kPageBytes) +
                         (bytes.size() < kPages * kPageBytes
                              ? "; it was cut, so copy it again"
                              : "; there are more bytes after the last page, so copy it again"));
  std::vector<size_t> full;
  std::vector<bool> follows(kPages, false);
  std::vector<std::string> damaged;
  for (size_t page = 0; page < kPages; ++page) {
    if (!is_sound(bytes, page)) {
      const std::string name = page_name(bytes, page);
      if (byte_at(bytes, page * kPageBytes + kStepCount) > 0)
        damaged.push_back(std::to_string(page) + (name.empty() ? "" : " '" + name + "'"));
      continue;
    }
    full.push_back(page);
    const size_t next = byte_at(bytes, page * kPageBytes + kNext);
    if (next != page) follows[next] = true;
  }
  if (full.empty())
    source.refuse(
        0,
        "no page has both steps and a correct checksum; the file may be damaged, so save it again");
  // A motion is a page that follows no other one, and the pages that follow it.
  std::vector<size_t> starts;
  for (const size_t page : full)
    if (!follows[page]) starts.push_back(page);
  if (starts.empty()) starts = full;  // the pages follow each other in a circle
  std::vector<std::string> names;
  for (const size_t page : starts) names.push_back(page_name(bytes, page));
  MotionFile motion;
  if (!damaged.empty())
    motion.notes.push_back(text::counted(damaged.size(), "damaged page") +
                           (damaged.size() == 1 ? " is" : " are") +
                           " left out (wrong checksum, or more than 7 steps): " +
                           text::join_first(damaged, kNamedPages));
  const size_t start = starts[source.chosen_motion(names, starts, motion)];
  std::vector<std::array<int, kServos>> rows;
  std::array<bool, kServos> used = {};
  std::vector<bool> played(kPages, false);
  double now = 0;
  size_t pages = 0;
  for (size_t page = start;;) {
    const size_t begin = page * kPageBytes, count = byte_at(bytes, begin + kStepCount);
    if (played[page] || count == 0) break;
    if (!is_sound(bytes, page))
      source.refuse(
          0, "page " + std::to_string(page) +
                 " belongs to the motion, but it is damaged (wrong checksum, or more than 7 "
                 "steps). Save this page again in the action editor, or choose another motion "
                 "with --motion");
    played[page] = true;
    if (const size_t times = byte_at(bytes, begin + kRepeat); times > 1)
      motion.notes.push_back("page " + std::to_string(page) +
                             " is read once, although the robot plays this page " +
                             std::to_string(times) + " times");
    ++pages;
    const auto speed = static_cast<double>(std::max<size_t>(byte_at(bytes, begin + kSpeed), 1));
    for (size_t s = 0; s < count; ++s) {
      const size_t step = begin + kStepBytes * (s + 1);
      const double time =
          static_cast<double>(byte_at(bytes, step + 63)) * kUsualSpeed / speed * kTick;
      const double pause =
          static_cast<double>(byte_at(bytes, step + 62)) * kUsualSpeed / speed * kTick;
      if (!rows.empty()) now += std::max(time, kTick);
      std::array<int, kServos> row;
      for (size_t id = 0; id < kServos; ++id) {
        const int value = position_at(bytes, step, id);
        const bool set = id > 0 && (value & (kNotUsed | kTorqueOff)) == 0;
        if (set && value >= 2 * kZero)
          source.refuse(0, "page " + std::to_string(page) + ", step " + std::to_string(s + 1) +
                               ", servo " + std::to_string(id) + ": the position " +
                               std::to_string(value) +
                               " is not one of 0 to 4095; correct it in the action editor");
        row[id] = set ? value : -1;
        used[id] = used[id] || set;
      }
      rows.push_back(row);
      motion.times.push_back(now);
      if (pause <= 0) continue;
      now += pause;
      rows.push_back(row);
      motion.times.push_back(now);
    }
    page = byte_at(bytes, begin + kNext);
    if (page == 0) break;
  }
  if (rows.size() == 1) {  // one posture, which the robot holds
    rows.push_back(rows.front());
    motion.times.push_back(now + kHeld);
    motion.notes.push_back("the file has one posture, which is held for " + text::brief(kHeld) +
                           " s");
  }
  motion.values.resize(static_cast<Eigen::Index>(rows.size()), 0);
  for (size_t id = 0; id < kServos; ++id) {
    if (!used[id]) continue;
    std::string joint = "ID " + std::to_string(id);
    for (const Dof& dof : source.model.dofs())
      if (dof.encoder.device == static_cast<int>(id)) joint = dof.name;
    motion.joints.push_back(joint);
    const Eigen::Index column = motion.values.cols();
    motion.values.conservativeResize(Eigen::NoChange, column + 1);
    for (size_t k = 0; k < rows.size(); ++k)
      motion.values(static_cast<Eigen::Index>(k), column) =
          rows[k][id] < 0 ? std::numeric_limits<double>::quiet_NaN()
                          : (rows[k][id] - kZero) * kCount;
  }
  motion.keys = true;
  motion.sequence = bytes;
  motion.notes.push_back(
      "units: a turn of a servo has 4096 counts, the count 2048 is 0 rad, and times are in units "
      "of "
      "8 ms");
  motion.notes.push_back("the motion has " + text::counted(pages, "page") +
                         ", beginning with page " + std::to_string(start));
  return motion;
}

std::vector<WrittenFile> write_op3_action(const RobotModel& model, const MotionFile& motion) {
  const double units = 1 / motion.rate / kTick;
  const long time = std::lround(units);
  const auto rows = static_cast<size_t>(motion.rows());
  if (time < 1 || time > 255 || std::abs(units - static_cast<double>(time)) > 1e-6)
    fail(ErrorCode::bad_file,
         "the time between two steps of an action file is a multiple of 8 ms, at most 2.04 s, but "
         "the rows are " +
             text::brief(1000 / motion.rate) +
             " ms apart; choose another time between rows, for example --interval 8, 16, 40 or 80");
  if (rows > (kPages - 1) * kSteps)
    fail(ErrorCode::bad_file,
         "the motion has " + std::to_string(rows) + " rows, but an action file has at most " +
             std::to_string((kPages - 1) * kSteps) + " steps; choose a longer --interval");
  std::vector<size_t> servo;
  for (const std::string& joint : motion.joints) {
    const int device = model.dofs()[static_cast<size_t>(model.find_dof(joint))].encoder.device;
    if (device < 1 || device >= static_cast<int>(kServos))
      fail(ErrorCode::bad_model,
           joint +
               ": the joint has no servo number from 1 to 30; give its device "
               "in \"encoders\" of the sidecar");
    servo.push_back(static_cast<size_t>(device));
  }
  std::string bytes(kPages * kPageBytes, '\0');
  const auto set = [&](size_t at, size_t value) { bytes[at] = static_cast<char>(value & 0xff); };
  for (size_t page = 0; page < kPages; ++page) {
    const size_t begin = page * kPageBytes;
    const size_t first = page > 0 ? (page - 1) * kSteps : rows;
    const size_t count = first < rows ? std::min(kSteps, rows - first) : 0;
    set(begin + kRepeat, 1);
    set(begin + kSchedule, 0x0a);  // Definition: steps have a time, not a speed
    set(begin + kSpeed, kUsualSpeed);
    set(begin + kAccel, kUsualSpeed);
    set(begin + kStepCount, count);
    set(begin + kNext, count > 0 && first + count < rows ? page + 1 : 0);
    set(begin + kExit, 0);
    for (size_t i = 0; i < 31; ++i) set(begin + kGain + i, 0x55);  // Definition: the usual gain
    if (page == 1)
      for (size_t i = 0; i < std::min(kNameBytes, motion.name.size()); ++i)
        bytes[begin + i] = motion.name[i];
    for (size_t s = 0; s < kSteps; ++s) {
      const size_t step = begin + kStepBytes * (s + 1);
      for (size_t id = 0; id < kServos; ++id) {
        set(step + 2 * id, kNotUsed);
        set(step + 2 * id + 1, kNotUsed >> 8);
      }
      if (s >= count) continue;
      set(step + 63, static_cast<size_t>(time));
      for (size_t j = 0; j < servo.size(); ++j) {
        const double angle =
            motion.values(static_cast<Eigen::Index>(first + s), static_cast<Eigen::Index>(j));
        const long value = std::lround(angle / kCount) + kZero;
        if (value < 0 || value > 4095)
          fail(ErrorCode::bad_file,
               motion.joints[j] + ": " + text::brief(angle) +
                   " rad is outside the 4096 counts of a servo (-pi to pi rad)");
        set(step + 2 * servo[j], static_cast<size_t>(value));
        set(step + 2 * servo[j] + 1, static_cast<size_t>(value) >> 8);
      }
    }
    set(begin + kChecksum, checksum_of(bytes, page));
  }
  return {{"", bytes}};
}

}  // namespace ayumi
