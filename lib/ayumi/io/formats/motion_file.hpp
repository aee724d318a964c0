#pragma once
// A motion as a file of any format holds it: what every reader fills and every writer takes.

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
  std::vector<double> times;        ///< one per row [s]; empty: `rate`, else the user states it
  double rate = 0;                  ///< of rows without times [1/s]; 0: the file does not state it
  double time_step = 0;             ///< to which the times of the format are rounded [s]
  std::vector<std::string> joints;  ///< of the columns; empty: the format names none
  Eigen::MatrixXd values;           ///< rows x columns [rad or m]; NaN: not set in this row
  std::vector<BasePose> base;       ///< root link; empty or one per row, world
  std::vector<Eigen::Vector3d> cog, zmp;  ///< empty or one per row, world [m]
  std::vector<double> fz;                 ///< empty or one per row [N]
  Eigen::MatrixXd torque;                 ///< empty or rows x columns [N m]
  std::vector<Support> support;           ///< empty or one per row
  bool keys = false;      ///< rows are key postures, between which a player interpolates
  bool commands = false;  ///< values are what servos receive
  /// Where the unit of the angles stands: the format defines it, the reader has converted each
  /// column by its own unit, or it is what the user says.
  enum class Unit { of_format, of_columns, assumed } unit = Unit::of_format;
  int file_rows = 0;                    ///< data rows of the file; 0: as many as rows()
  TableCaution caution = {};            ///< of the run that the table is from
  std::string sequence = {};            ///< bytes of a HOAP sequence, kept to be exported unchanged
  std::string name = {};                ///< of the motion, where the format has one
  bool chosen = false;                  ///< ImportOptions::motion was used
  std::vector<std::string> notes = {};  ///< what was assumed or left out, in words

  Eigen::Index rows() const { return values.rows(); }
};

/// What a reader receives.
struct MotionInput {
  std::string bytes;  ///< text: UTF-8 without mark, lines end with \n; else as in the file
  std::string file;   ///< for messages and for files beside it
  const RobotModel& model;
  const ImportOptions& options;

  /// The file of the same name with another extension (".zmp"); none where there is no such file.
  std::optional<std::string> beside(const std::string& extension) const;
  /// Throws Error(bad_file) "file:line: reason"; line 0 is left out.
  [[noreturn]] void refuse(size_t line, const std::string& reason) const;
  /// Index of the motion that the options ask for among those of the file; the first where they ask
  /// for none. Numbers are `numbers`, from 1 where they are empty. Says in `motion` which one it is
  /// and which ones there are. Throws as refuse() where there is none of that name or number.
  size_t chosen_motion(const std::vector<std::string>& names, const std::vector<size_t>& numbers,
                       MotionFile& motion) const;
  /// A finite number; `where` names the place in the line. Throws as refuse().
  double number(std::string_view cell, size_t line, const std::string& where = "") const;
};

/// Index of the robot's joint with this name or alias (RobotDescription::aliases); -1: none.
int find_joint(const RobotModel& model, const std::string& name);

/// One file that a writer makes; formats of several files name their extensions (".zmp").
struct WrittenFile {
  std::string extension;  ///< "": the name that was asked for
  std::string bytes;
};

/// Rows of numbers between blanks, without empty lines and comments (#).
struct NumberRows {
  std::vector<std::vector<double>> rows;
  std::vector<size_t> lines;  ///< of each row in the file, from 1
};
/// Throws as MotionInput::refuse for a cell that is no finite number or a row of another length.
NumberRows number_rows(const MotionInput& source, std::string_view text,
                       const std::string& separators);

}  // namespace ayumi
