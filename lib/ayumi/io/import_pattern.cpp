#include "ayumi/io/import_pattern.hpp"

#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/io/formats/motion_formats.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/io/table/table.hpp"

namespace ayumi {

namespace fs = std::filesystem;

namespace {

void add_ramps(double seconds, const RobotModel& model, ImportedMotion& imported) {
  const CutEnds cut = cut_ends(model, imported.motion);
  if (seconds <= 0) {
    imported.filled.insert(imported.filled.end(), cut.words.begin(), cut.words.end());
    return;
  }
  const std::string ends = cut.begin && cut.end ? "at the beginning and at the end"
                           : cut.begin          ? "at the beginning"
                                                : "at the end";
  if (!cut.begin && !cut.end) {
    imported.filled.push_back("--ramp is not used, because the motion begins and ends at rest");
    return;
  }
  if (!imported.motion.zmp.empty() || !imported.motion.fz.empty())
    imported.filled.push_back(
        "the ZMP and the vertical force of the file are left out, because a ramp changes them");
  imported.motion = with_ramps(model, std::move(imported.motion), seconds);
  imported.sequence.clear();  // its rows are no longer the rows of the motion
  imported.filled.push_back("with --ramp, the motion takes " + text::brief(seconds) +
                            " s between rest and the recorded speed " + ends +
                            ". The path stays as recorded");
}

void require_bounds(const PatternImport& options) {
  if (options.ramp != 0) require_within("the time of the ramp", options.ramp, PatternImport::kRamp);
  const ContactThresholds& contact = options.contact;
  require_within("the largest height of a sole that carries the robot", contact.height,
                 ContactThresholds::kHeight);
  require_within("the largest speed of a sole that carries the robot", contact.speed,
                 ContactThresholds::kSpeed);
  require_within("the smallest vertical force of a contact", contact.load,
                 ContactThresholds::kLoad);
}

ImportedPattern of_keys(ImportedKeys keys, const PatternImport& options) {
  ImportedPattern result;
  result.pattern = std::move(keys.pattern);
  result.format = keys.format;
  result.reason = keys.reason;
  result.rows = static_cast<int>(result.pattern.keyframes.size());
  result.filled = std::move(keys.filled);
  if (options.ground || options.ramp > 0)
    result.filled.push_back(
        "--ground and --ramp are not used, because they apply only to files with rows of joint "
        "angles, and this file has key poses");
  return result;
}

ImportedPattern of_rows(const RobotModel& model, ImportedMotion imported,
                        const PatternImport& options) {
  imported.motion.contact = options.contact;
  // Bytes that hold angles of joints are nothing that this unit may receive.
  if (options.reading.measured_at == MeasuredAt::joint && !encoder_zeros(model).isZero(0))
    imported.sequence.clear();
  add_ramps(options.ramp, model, imported);
  if (options.ground) imported.motion = put_on_ground(model, std::move(imported.motion));
  GroundedMotion motion = grounded(model, imported.motion, "motion.csv");
  ImportedPattern result;
  result.pattern = std::move(motion.pattern);
  result.pattern.name = imported.name;
  result.format = imported.format;
  result.reason = imported.reason;
  result.rows = imported.rows;
  result.contacts = std::move(motion.contacts);
  result.filled = std::move(imported.filled);
  result.filled.insert(result.filled.end(), motion.notes.begin(), motion.notes.end());
  result.caution = imported.caution;
  result.sequence = std::move(imported.sequence);
  if (!result.sequence.empty()) result.pattern.table->encoders = encoders_of(model);
  if (!result.sequence.empty() && result.format == "hoap")
    result.pattern.table->interval_ms = static_cast<int>(std::lround(1000 * imported.motion.dt));
  return result;
}

}  // namespace

bool is_pattern_text(const std::string& bytes) {
  return bytes.find("\"ayumi.pattern/") != std::string::npos;
}

ImportedPattern import_pattern(const std::string& bytes, const std::string& file,
                               const RobotModel& model, const PatternImport& options) {
  require_bounds(options);
  if (is_pattern_text(bytes))
    fail(ErrorCode::bad_file, {file},
         "this file is already a pattern of Ayumi, so it needs no import; import reads motions in "
         "the formats " +
             text::join(read_format_names(), ", "));
  std::optional<ImportedKeys> keys = read_key_poses(bytes, file, model, options.reading);
  ImportedPattern result =
      keys ? of_keys(std::move(*keys), options)
           : of_rows(model, read_motion(bytes, file, model, options.reading), options);
  if (result.pattern.name.empty())
    result.pattern.name = "imported from " + fs::path(file).filename().string();
  result.pattern.file = "imported";  // names are relative to the working folder
  return result;
}

fs::path copy_beside(const fs::path& path, const std::string& format) {
  return format == "hoap" ? sequence_beside(path)
                          : fs::path(path).replace_extension(".sequence.bin");
}

std::optional<std::string> kept_file(const DenseTable& table, const std::string& format,
                                     const RobotModel& model) {
  // The ending of the copy's name says which format it has.
  if (!table.sequence || !table.sequence->file.ends_with(copy_beside("", format).string()) ||
      theta_sha256(table) != table.sequence->theta_sha256 || !read_with_encoders_of(model, table))
    return {};
  return kept_sequence(table);
}

std::vector<fs::path> files_of_import(const fs::path& path) {
  return {path, table_beside(path), sequence_beside(path), copy_beside(path, "op3-action")};
}

void write_imported(const fs::path& path, ImportedPattern& imported) {
  if (imported.sequence.empty() || !imported.pattern.table) {
    write_pattern_and_table(path, imported.pattern, imported.filled, imported.caution);
    return;
  }
  const bool rows = imported.format == "hoap";
  const fs::path copy = copy_beside(path, imported.format);
  imported.filled.push_back("a copy of the " + std::string(rows ? "sequence" : "file") +
                            " is kept in " + copy.filename().string() +
                            ". As long as the motion is not changed, `ayumi export" +
                            (rows ? "" : " --format " + imported.format) + "` writes " +
                            (rows ? "the rows of this copy" : "the bytes of this copy"));
  if (rows) {
    write_pattern_and_table(path, imported.pattern, imported.filled, imported.caution,
                            imported.sequence);
    return;
  }
  DenseTable& table = *imported.pattern.table;
  table.sequence = {fs::absolute(copy).lexically_normal().string(), sha256(imported.sequence),
                    theta_sha256(table)};
  write_file(copy, imported.sequence);
  try {
    write_pattern_and_table(path, imported.pattern, imported.filled, imported.caution);
  } catch (...) {
    std::error_code ignored;
    fs::remove(copy, ignored);
    throw;
  }
}

}  // namespace ayumi
