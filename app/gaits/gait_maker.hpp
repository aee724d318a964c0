#pragma once
// Makes the walks of a library. Each walk is generated, checked, repaired if necessary, closed to a
// cycle, simulated and certified. Also makes the walks that change from one cell to a neighbour.

#include <nlohmann/json.hpp>

#include "ayumi/author/generate/generate.hpp"
#include "ayumi/io/pattern/study_file.hpp"
#include "ayumi/study/certify.hpp"
#include "ayumi/task/task.hpp"
#include "gaits/gait_grid.hpp"
#include "gaits/library_folder.hpp"

namespace ayumi::app {

/// Requirements for every walk.
struct GaitOptions {
  std::string robot;       ///< robot as patterns in the folder of patterns name it
  std::string profile;     ///< actuator profile; "" for the robot's default
  std::string controller;  ///< controller; "" for that of new patterns
  double cog_height = 0;   ///< height of the COG; 0 for starting_height() [m]
  double rate = 50;        ///< rate of the rows of tables and archives [1/s]
  /// Whether cells are certified; if not, there is one run of the robot as it is modelled.
  bool certify = true;
  CertifyOptions study;    ///< study of each cell; its number of threads is not used
  std::string study_file;  ///< file of the uncertainty; "" for that of the robot
  bool transitions = true;
};

/// A cell or a transition that was made, or the reason why there is none. `json` is its entry in
/// the index.
struct GaitResult {
  nlohmann::ordered_json json;
  LibraryFiles files;
};

class GaitMaker {
 public:
  /// Throws Error(bad_model) for an unknown profile or a robot without soles, and the same errors
  /// as load_study().
  GaitMaker(RobotModel model, const GaitOptions& options);

  const RobotModel& model() const { return model_; }
  const std::string& profile() const { return profile_; }
  const Study& study() const { return study_; }
  const ControllerSpec& controller() const { return controller_; }

  /// The COG height with which most of the cells pass the check without a repair. If there are
  /// several, the one nearest to the height of new walks. 0 means the height of new walks [m].
  double best_height(const std::vector<GaitCell>& cells, int threads,
                     const Progress& progress) const;
  /// Sets the COG height of all walks from now on; 0 for that of new walks [m].
  void use_height(double height) { options_.cog_height = height; }
  double height() const;

  /// Makes a cell. The result is the same for any number of threads, all of which may call this.
  GaitResult make(const GaitCell& cell, const Progress& progress) const;
  /// Makes a walk from one cell to another.
  GaitResult change(const GaitCell& from, const GaitCell& to, const Progress& progress) const;

  /// The walk of a cell, with `steps` moving steps and one more step that brings the feet together.
  WalkParameters walk(const GaitCell& cell, int steps) const;
  /// Number of steps at the beginning of a walk that depend on its start, and of steps at its end
  /// that depend on this end.
  int memory(double period) const;
  /// memory() rounded up to an even number: the number of steps before the first cycle. Each cycle
  /// then begins with the same foot.
  int lead(double period) const;

 private:
  struct Made;
  // These functions throw Missing, the reason why the walk is missing.
  Made made(Pattern pattern, const Progress& progress) const;
  void simulate(const Task& task, nlohmann::ordered_json& json, const Progress& progress) const;
  void make(const GaitCell& cell, GaitResult& result, const Progress& progress) const;
  void change(const GaitCell& from, const GaitCell& to, GaitResult& result,
              const Progress& progress) const;

  static void add_figures(const Made& walk, nlohmann::ordered_json& json);

  RobotModel model_;
  GaitOptions options_;
  std::string profile_;
  Study study_;
  ControllerSpec controller_;
};

}  // namespace ayumi::app
