#pragma once
// Motions of other origin: HOAP sequences as the real robots' files are, tables of angles, and the
// joint tables Ayumi writes. What was understood, filled in or left out is said in words.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

struct ImportOptions {
  std::string format{};       ///< "hoap", "csv", "json"; "" by the content
  bool degrees = false;       ///< unit of bare joint columns
  double rate = 0;            ///< of rows without a time column [1/s]
  bool commands = false;      ///< angles are what servos receive, as in Ayumi's reference tables
  bool encoder_signs = true;  ///< rows of radians have the signs of the encoders, not of the joints
  std::optional<double> smooth{};  ///< largest change of an angle [deg]; left out: 0.1 of counts,
                                   ///< none of angles
};

struct ImportedMotion {
  RawMotion motion;
  std::string format;               ///< "hoap", "csv" or "json"
  int rows = 0;                     ///< data rows of the file
  bool commands = false;            ///< motion.theta is what servos receive
  TableCaution caution = {};        ///< of the run that the table is from
  std::string sequence = {};        ///< bytes of a HOAP sequence, kept to be exported unchanged
  std::vector<std::string> filled;  ///< what the file does not say, or says beside the motion
};

/// A HOAP sequence in one of the robot's layouts (io/formats/hoap.hpp). General commands (3) only
/// take their time. Where intervals change, rows are interpolated linearly on their greatest common
/// divisor. Rows without an interval have that of their layout, or `rate` [1/s]; those of radians
/// have the signs of the encoders unless `encoder_signs` is false. Throws Error(bad_file) as
/// parse_hoap, and where a device moves that the robot does not have.
ImportedMotion read_hoap_motion(const std::string& bytes, const std::string& file,
                                const RobotModel& model, double rate = 0,
                                bool encoder_signs = true);

/// A head row and numbers: t[s] (or t, time, time_ms), joints as theta.<joint>[rad] or by their
/// names, bare or with a unit as in r_knee[deg], and whole groups of cog, zmp, fz, base, contact
/// columns as in Ayumi's tables. Rows that are not evenly spaced are interpolated. Throws
/// Error(bad_file) naming the column or row.
ImportedMotion read_table_motion(const std::string& bytes, const std::string& file,
                                 const RobotModel& model, const ImportOptions& options = {});

/// Either of them, by the content. `bytes` from `file`. Postures: where the file holds commands,
/// the servos' lead is taken out. Angles are then smoothed within what ImportOptions::smooth says.
ImportedMotion read_motion(const std::string& bytes, const std::string& file,
                           const RobotModel& model, const ImportOptions& options = {});

}  // namespace ayumi
