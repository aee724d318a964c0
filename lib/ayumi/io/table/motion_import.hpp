#pragma once
// Motions of other programs and robots, in the formats of io/formats/motion_formats.hpp, fitted to
// a robot. What was understood, assumed, filled in or left out is listed in words.

#include <optional>
#include <string>
#include <vector>

#include "ayumi/author/import/contact_reconstruction.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

struct ImportOptions {
  std::string format{};       ///< name of motion_formats(); "" by the content
  bool degrees = false;       ///< unit of angles where the format does not define it
  double rate = 0;            ///< of rows without times [1/s]
  bool commands = false;      ///< angles are what servos receive, as in Ayumi's reference tables
  bool encoder_signs = true;  ///< rows of radians have the signs of the encoders, not of the joints
  std::optional<double> smooth{};  ///< largest change of an angle [deg]; left out: 0.1 of counts,
                                   ///< none of angles
  bool by_order = false;           ///< columns are the robot's joints in its own order
  std::vector<std::string> joints{};  ///< names of the columns, in the order of the file
  std::string motion{};  ///< name or number of the motion, of a file with several; "": the first
};

struct ImportedMotion {
  RawMotion motion;
  std::string format;               ///< name of motion_formats()
  std::string reason;               ///< why the content is of this format; "" where it was stated
  int rows = 0;                     ///< data rows of the file
  bool commands = false;            ///< motion.theta is what servos receive
  TableCaution caution = {};        ///< of the run that the table is from
  std::string sequence = {};        ///< bytes of a HOAP sequence, kept to be exported unchanged
  std::vector<std::string> filled;  ///< assumptions, and other content of the file, in words
};

/// A file of key poses as a pattern.
struct ImportedKeys {
  Pattern pattern;                       ///< without robot and name
  std::string format;                    ///< name of motion_formats()
  std::string reason;                    ///< as ImportedMotion::reason
  std::vector<std::string> filled = {};  ///< what was assumed or left out
};

/// The keys of a file of key poses; none for a file of any other format. Throws as
/// read_motion_rows().
std::optional<ImportedKeys> read_key_poses(const std::string& bytes, const std::string& file,
                                           const RobotModel& model,
                                           const ImportOptions& options = {});

/// The rows of a file as they are, evenly spaced, with the columns of the robot's joints. Joints
/// are mapped by their names or the robot's aliases, and by order only where the options say so.
/// Unset values and rows between key postures are interpolated. Throws Error(bad_file) that names
/// the format, the place and the remedy.
ImportedMotion read_motion_rows(const std::string& bytes, const std::string& file,
                                const RobotModel& model, const ImportOptions& options = {});

/// The same as postures: where the file holds commands, the servos' lead is taken out. Angles are
/// then smoothed within what ImportOptions::smooth says.
ImportedMotion read_motion(const std::string& bytes, const std::string& file,
                           const RobotModel& model, const ImportOptions& options = {});

}  // namespace ayumi
