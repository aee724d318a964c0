#include "ayumi/io/formats/hrpsys.hpp"

#include <charconv>
#include <cmath>
#include <filesystem>

#include "ayumi/base/text.hpp"
#include "ayumi/io/table/comma_cells.hpp"
#include "ayumi/math/elementary.hpp"
#include "ayumi/math/rotation.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

std::string blanks() { return " \t"; }

// A file beside the .pos file, with one row for each row of the .pos file.
std::optional<NumberRows> rows_beside(const MotionInput& source, const std::string& extension,
                                      size_t rows) {
  const std::optional<std::string> bytes = source.beside(extension);
  if (!bytes) return {};
  const std::string name = fs::path(source.file).replace_extension(extension).string();
  const MotionInput other{*bytes, name, source.model, source.options};
  NumberRows table = number_rows(other, other.bytes, blanks());
  if (table.rows.size() != rows)
    other.refuse(0, "this file has " + std::to_string(table.rows.size()) +
                        " rows, but the .pos file has " + std::to_string(rows));
  return table;
}

void require_width(const MotionInput& source, const NumberRows& table, const std::string& extension,
                   const std::vector<size_t>& allowed) {
  const size_t width = table.rows.front().size() - 1;
  std::vector<std::string> counts;
  for (const size_t one : allowed) {
    if (width == one) return;
    counts.push_back(std::to_string(one));
  }
  const std::string name = fs::path(source.file).replace_extension(extension).string();
  MotionInput{"", name, source.model, source.options}.refuse(
      table.lines.front(), "the row has " + std::to_string(width) + " values after the time, but " +
                               text::join(counts, " or ") + " are needed");
}

Eigen::Vector3d vector_at(const std::vector<double>& row, size_t at) {
  return {row[at], row[at + 1], row[at + 2]};
}

// A row has x y z and roll pitch yaw, or, in the older form, x y z and the rotation matrix row by
// row.
BasePose waist_of(const std::vector<double>& row) {
  BasePose base;
  base.position = vector_at(row, 1);
  if (row.size() == 7) {
    base.attitude = Eigen::Quaterniond(rpy_to_matrix(vector_at(row, 4)));
    return base;
  }
  Eigen::Matrix3d rotation;
  for (int i = 0; i < 9; ++i) rotation(i / 3, i % 3) = row[static_cast<size_t>(4 + i)];
  base.attitude = Eigen::Quaterniond(rotation).normalized();
  return base;
}

std::string row_text(double time, const std::vector<double>& values) {
  std::string text = text::exact(time);
  for (const double value : values) text += " " + text::exact(value);
  return text + "\n";
}

}  // namespace

std::string recognize_hrpsys(const MotionInput& source) {
  std::string_view rest = source.bytes;
  double before = 0;
  for (int rows = 0; rows < 3;) {
    if (rest.empty()) return "";
    std::string_view line = take_line(rest);
    if (line.empty() || is_comment(line)) continue;
    if (line.find_first_not_of("0123456789+-.,eE \t") != std::string_view::npos ||
        line.find_first_of(" \t") == std::string_view::npos)
      return "";
    if (line.find(',') != std::string_view::npos)
      return line.find(", ") == std::string_view::npos
                 ? "the rows are numbers with decimal commas, with blanks between them"
                 : "";
    double time = 0;
    std::from_chars(line.data(), line.data() + line.size(), time);
    if (rows > 0 && !(time > before)) return "";
    before = time;
    ++rows;
  }
  return "the rows are numbers with blanks between them, and the first number increases like a "
         "time";
}

MotionFile read_hrpsys(const MotionInput& source) {
  const std::string extension = fs::path(source.file).extension().string();
  for (const char* other : {".zmp", ".waist", ".hip", ".torque", ".gsens", ".wrenches"})
    if (extension == other)
      source.refuse(0, "this file has no joint angles; name the .pos file beside it");
  const NumberRows table = number_rows(source, source.bytes, blanks());
  const size_t rows = table.rows.size(), width = table.rows.front().size();
  if (width < 2) source.refuse(table.lines.front(), "the row has a time, but no angle");
  MotionFile motion;
  motion.values.resize(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(width - 1));
  for (size_t k = 0; k < rows; ++k) {
    motion.times.push_back(table.rows[k][0]);
    if (k > 0 && !(motion.times[k] > motion.times[k - 1]))
      source.refuse(table.lines[k], "time " + text::brief(motion.times[k]) +
                                        " s does not come after " +
                                        text::brief(motion.times[k - 1]) +
                                        " s of the row before; times must increase");
    for (size_t i = 1; i < width; ++i)
      motion.values(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i - 1)) =
          table.rows[k][i];
  }
  motion.notes.push_back("units: seconds, radians and metres, as the format defines them");
  if (const auto waist = rows_beside(source, ".waist", rows)) {
    require_width(source, *waist, ".waist", {6, 12, 18});
    for (const std::vector<double>& row : waist->rows) motion.base.push_back(waist_of(row));
    if (const auto hip = rows_beside(source, ".hip", rows)) {
      require_width(source, *hip, ".hip", {3});
      double most = 0;
      for (size_t k = 0; k < rows; ++k) {
        const Eigen::Quaterniond q(rpy_to_matrix(vector_at(hip->rows[k], 1)));
        most = std::max(most, elementary::angle_between(q, motion.base[k].attitude));
      }
      // The largest difference that rounding to six decimals explains. Chosen [rad].
      constexpr double kRounding = 1e-5;
      if (most > kRounding) {
        for (size_t k = 0; k < rows; ++k)
          motion.base[k].attitude = Eigen::Quaterniond(rpy_to_matrix(vector_at(hip->rows[k], 1)));
        motion.notes.push_back(
            "the attitudes in the .hip file and in the .waist file differ by up to " +
            text::brief(most * 180 / EIGEN_PI) +
            " deg. Ayumi uses the .hip file, as the SequencePlayer of hrpsys does");
      }
    }
  }
  if (const auto zmp = rows_beside(source, ".zmp", rows)) {
    require_width(source, *zmp, ".zmp", {3});
    if (motion.base.empty()) {
      motion.notes.push_back(
          "the ZMP is left out, because the file states it relative to the waist, and there is no "
          ".waist file");
    } else {
      double off = 0;
      for (size_t k = 0; k < rows; ++k) {
        const Eigen::Vector3d local = vector_at(zmp->rows[k], 1);
        motion.zmp.push_back(motion.base[k].position + motion.base[k].attitude * local);
        off = std::max(off, std::abs(motion.zmp.back().z()));
      }
      // If the ZMP, read relative to the waist, is nearer to the ground than this, it is taken to
      // be relative to the waist [m]. Chosen: a tenth of the height of a small robot's waist.
      constexpr double kNearGround = 0.03;
      motion.notes.push_back(
          off < kNearGround
              ? "the ZMP is relative to the waist, as the format defines it"
              : "if the ZMP is read relative to the waist, as the format defines it, the ZMP is up "
                "to " +
                    text::brief(1000 * off) +
                    " mm away from the ground. The file may state the ZMP in another frame");
    }
  }
  if (const auto torque = rows_beside(source, ".torque", rows)) {
    require_width(source, *torque, ".torque", {width - 1});
    motion.notes.push_back(
        "the torques of the .torque file are left out, because a pattern has no torques");
  }
  return motion;
}

std::vector<WrittenFile> write_hrpsys(const RobotModel&, const MotionFile& motion) {
  std::vector<WrittenFile> files = {{".pos", ""}, {".waist", ""}, {".hip", ""}};
  if (!motion.zmp.empty()) files.push_back({".zmp", ""});
  if (motion.torque.size() > 0) files.push_back({".torque", ""});
  for (Eigen::Index k = 0; k < motion.rows(); ++k) {
    const auto at = static_cast<size_t>(k);
    const double time = motion.times[at];
    const BasePose& base = motion.base[at];
    const Eigen::Vector3d& p = base.position;
    const Eigen::Vector3d rpy =
        matrix_to_rpy(base.attitude.toRotationMatrix()).unaryExpr(&repeatable);
    for (WrittenFile& file : files) {
      const auto row = [](const auto& values) {
        return std::vector<double>(values.begin(), values.end());
      };
      if (file.extension == ".pos") file.bytes += row_text(time, row(motion.values.row(k)));
      if (file.extension == ".torque") file.bytes += row_text(time, row(motion.torque.row(k)));
      if (file.extension == ".hip") file.bytes += row_text(time, row(rpy));
      if (file.extension == ".waist")
        file.bytes += row_text(time, {p.x(), p.y(), p.z(), rpy.x(), rpy.y(), rpy.z()});
      if (file.extension == ".zmp") {
        const Eigen::Vector3d local = base.attitude.inverse() * (motion.zmp[at] - p);
        file.bytes += row_text(time, row(local.unaryExpr(&repeatable).eval()));
      }
    }
  }
  return files;
}

}  // namespace ayumi
