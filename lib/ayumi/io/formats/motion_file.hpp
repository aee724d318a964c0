#pragma once
// A motion with the content that a file of any format has. Every reader fills it, and every writer
// takes it.

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ayumi/io/table/motion_import.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/pattern.hpp"
#include "ayumi/motion/table_caution.hpp"

namespace ayumi {

/// Largest distance of a quaternion's length from 1 in a file. Chosen: files with four decimals
/// stay below half of it; the lengths of other columns are far from 1.
inline constexpr double kUnitQuaternion = 0.01;

struct MotionFile {
  /// Time of each row [s]; empty if `rate` is used, or if the user states the rate.
  std::vector<double> times;
  double rate = 0;       ///< rate of rows without times [1/s]; 0 if the file does not state it
  double time_step = 0;  ///< step to which the format rounds its times [s]
  std::vector<std::string> joints;  ///< joint of each column; empty if the format names none
  Eigen::MatrixXd values;           ///< rows x columns [rad or m]; NaN: not set in this row
  std::vector<BasePose> base;  ///< poses of the root link in the world; empty or one for each row
  std::vector<Eigen::Vector3d> cog, zmp;  ///< places in the world [m], one for each row or none
  std::vector<double> fz;                 ///< empty or one for each row [N]
  Eigen::MatrixXd torque;                 ///< empty, or rows x columns [N m]
  std::vector<Support> support;           ///< empty or one for each row
  bool keys = false;      ///< rows are key postures, between which a player interpolates
  bool commands = false;  ///< values are what servos receive
  /// Values are angles of joints, because the file states the zeros of its encoders (or none), and
  /// the reader has added them.
  bool of_joints = false;
  /// Origin of the unit of the angles: the format defines it, or the reader has converted each
  /// column by its own unit, or the user states it.
  enum class Unit { of_format, of_columns, assumed } unit = Unit::of_format;
  /// Joints whose columns state no unit, if others state theirs; ImportOptions::degrees has already
  /// been applied to them.
  std::vector<std::string> without_unit = {};
  int file_rows = 0;          ///< data rows of the file; 0 if there are as many as rows()
  TableCaution caution = {};  ///< caution of the run from which the table comes
  std::string sequence = {};  ///< bytes of a HOAP sequence, which are kept for an unchanged export
  std::string name = {};      ///< name of the motion, if the format has one
  bool chosen = false;        ///< whether ImportOptions::motion was used
  std::vector<std::string> notes = {};  ///< what was assumed or left out, in words

  Eigen::Index rows() const { return values.rows(); }
};

/// The data that a reader receives.
struct MotionInput {
  /// Text is UTF-8 without mark, its lines end with \n; other bytes are as in the file.
  std::string bytes;
  std::string file;  ///< name for messages and for files beside it
  const RobotModel& model;
  const ImportOptions& options;

  /// The file of the same name with another extension (".zmp"); nothing if there is no such file.
  std::optional<std::string> beside(const std::string& extension) const;
  /// Throws Error(bad_file) "file:line: reason"; if `line` is 0, it is left out.
  /// `names_remedy` as in SourcePlace.
  [[noreturn]] void refuse(size_t line, const std::string& reason, bool names_remedy = false) const;
  /// Index of the motion that the options ask for among the motions of the file; the first one if
  /// they ask for none. `numbers` are the numbers of the motions; if it is empty, they are counted
  /// from 1. Says in `motion` which one was taken and which ones there are. Throws the same errors
  /// as refuse() if there is none with this name or number.
  size_t chosen_motion(const std::vector<std::string>& names, const std::vector<size_t>& numbers,
                       MotionFile& motion) const;
  /// A finite number; `where` names the place in the line. Throws the same errors as refuse().
  double number(std::string_view cell, size_t line, const std::string& where = "") const;
};

/// Index of the robot's joint with this name or alias (RobotDescription::aliases), or else of the
/// only joint whose name differs in capital letters alone; -1 if there is none.
int find_joint(const RobotModel& model, const std::string& name);

/// One file that a writer makes. Formats with several files name their extensions (".zmp").
struct WrittenFile {
  std::string extension;  ///< extension of the name; "" for the name that the user has given
  std::string bytes;
};

/// A value that follows from an attitude [rad, m], rounded to 1e-12. A file that was read and is
/// written again then has the same values, because the errors of the conversion are below 1e-15.
double repeatable(double value);

/// Whether a line is a comment (# or %).
inline bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%');
}

/// Rows of numbers between blanks, without empty lines and comments.
struct NumberRows {
  std::vector<std::vector<double>> rows;
  std::vector<size_t> lines;  ///< line of each row in the file, counted from 1
};
/// Throws the same errors as MotionInput::refuse() for a cell that is not a finite number, and for
/// a row of another length.
NumberRows number_rows(const MotionInput& source, std::string_view text,
                       const std::string& separators);

}  // namespace ayumi
