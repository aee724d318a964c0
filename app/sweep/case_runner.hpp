#pragma once
// Runs the cases of a sweep, one at a time, from several threads. Patterns, robots and laws that
// consecutive cases share are made once.

#include <atomic>
#include <list>
#include <memory>
#include <mutex>

#include "ayumi/io/pattern/sweep_file.hpp"
#include "ayumi/study/uncertain_task.hpp"
#include "ayumi/task/task.hpp"
#include "commands.hpp"

namespace ayumi::app {

/// One cell of the results: nothing, a number, or a text.
using Cell = std::variant<std::monostate, double, std::string>;

struct ResultColumn {
  std::string name;  ///< name with its unit
  std::string type;  ///< "REAL", "INTEGER", "TEXT"
};

/// The results of one case.
struct CaseRow {
  long number = 0;
  std::vector<Cell> axes;  ///< values of the settings, in the order of SweepStudy::axes()
  std::string error;       ///< reason why the case could not be run; "" if it was run
  /// Figures in the order of result_columns(); empty cells after an error.
  std::vector<Cell> figures;
};

/// The figures that the study measures.
std::vector<ResultColumn> result_columns(const SweepMeasures& measures);

/// A file that the results depend on.
struct SweepInput {
  std::string kind;  ///< "study", "pattern", "robot", "uncertainty"
  std::string name;  ///< name as the study states it
  std::string sha256;
};

class CaseRunner {
 public:
  /// Reads every pattern and robot that the study names. The study must outlive this object. Throws
  /// Error(bad_file), Error(bad_model) or Error(bad_pattern) for input that no case can use: a file
  /// that does not exist, or a parameter or gain that nothing uses.
  CaseRunner(const Context& context, const SweepStudy& study);
  ~CaseRunner();

  const SweepStudy& study() const { return *study_; }
  const std::vector<ResultColumn>& columns() const { return columns_; }
  const std::vector<SweepInput>& inputs() const { return inputs_; }

  /// Runs a case. Bad input of a single case (such as a step that the legs cannot make) gives a row
  /// with an error. Any number of threads may call this function; the row only depends on the
  /// number. During a case, `progress` is asked again and again whether the work may continue; if
  /// it stops the work, Interrupted is thrown. A case that takes more than case_seconds() of
  /// processor time also gives a row with an error.
  CaseRow run(long number, const Progress& progress = {}) const;

  /// Largest processor time of one case [s]; 0: no limit.
  double case_seconds() const { return case_seconds_; }
  void limit_case(double seconds) { case_seconds_ = seconds; }

  /// The same simulation with its log, for a replay. `task` receives the task of the case.
  SimulationLog simulate(long number, std::shared_ptr<const Task>& task) const;

  /// The robot of a case with everything that only pictures need. Throws as load_robot().
  RobotModel robot_to_draw(long number) const;

  /// Processor time [s] that all threads used in run(), and the part of it in which they simulated,
  /// checked or repaired.
  double seconds() const { return 1e-9 * static_cast<double>(nanoseconds_); }
  double useful_seconds() const { return 1e-9 * static_cast<double>(useful_); }
  /// Processor time [s] for reading the inputs.
  double setup_seconds() const { return setup_seconds_; }

 private:
  struct Judged;
  struct Prepared;
  struct Law;
  struct Draws;
  struct OneCase;
  std::shared_ptr<Prepared> prepared(const Settings& settings) const;
  std::shared_ptr<const Law> law(Prepared& motion, const Settings& settings) const;
  /// Fills in the options of a case, and the objects to which they point, which stay in `made`.
  void make_case(long number, const Settings& settings, OneCase& made) const;
  std::filesystem::path pattern_file(const std::string& word) const;
  std::string robot_name(const std::string& word) const;
  /// The robot of a case with this pattern.
  std::string robot_of_case(const Settings& settings, const Pattern& pattern) const;
  void refuse_unused() const;
  void refuse_unused_gain(const std::string& gain, const std::string& pointer) const;
  void refuse_unusable_uncertainty() const;
  std::shared_ptr<const Draws> draws(Prepared& motion, const Settings& settings,
                                     const SimulateOptions& options) const;
  struct Watch;
  std::vector<Cell> figures(long number, const Settings& settings, Watch& watch) const;

  const Context* context_;
  const SweepStudy* study_;
  std::vector<ResultColumn> columns_;
  std::vector<SweepInput> inputs_;
  double setup_seconds_ = 0, case_seconds_ = 0;
  /// Patterns with default parameters, by the word in the study.
  std::map<std::string, Pattern> patterns_;
  std::map<std::string, RobotModel> robots_;
  mutable std::mutex mutex_;
  mutable std::list<std::shared_ptr<Prepared>> recent_;  ///< the most recently used one first
  mutable std::atomic<long> nanoseconds_ = 0, useful_ = 0;
};

}  // namespace ayumi::app
