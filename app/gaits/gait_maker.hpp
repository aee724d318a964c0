#pragma once
// Makes the walks of a library: each is generated, checked, repaired where it must be, closed to a
// cycle, simulated and certified; and the walks that change from one cell to a neighbour.

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
  std::string robot;       ///< as patterns in the folder of patterns name it
  std::string profile;     ///< actuator profile; "": the robot's default
  std::string controller;  ///< "": that of new patterns
  double cog_height = 0;   ///< 0: starting_height() [m]
  double rate = 50;        ///< of the rows of tables and archives [1/s]
  bool certify = true;     ///< false: one run of the robot as it is modelled
  CertifyOptions study;    ///< of each cell; its threads are not used
  std::string study_file;  ///< "": that of the robot
  bool transitions = true;
};

/// A cell or a transition that was made, or why there is none. `json` is its entry in the index.
struct GaitResult {
  nlohmann::ordered_json json;
  LibraryFiles files;
};

class GaitMaker {
 public:
  /// Throws Error(bad_model) for an unknown profile or a robot without soles, and as load_study().
  GaitMaker(RobotModel model, const GaitOptions& options);

  const RobotModel& model() const { return model_; }
  const std::string& profile() const { return profile_; }
  const Study& study() const { return study_; }
  const ControllerSpec& controller() const { return controller_; }

  /// The COG height with which most of the cells pass the check without a repair; of several, the
  /// one nearest to that of new walks. 0: that one [m].
  double best_height(const std::vector<GaitCell>& cells, int threads,
                     const Progress& progress) const;
  /// Of all walks from now on; 0: that of new walks [m].
  void use_height(double height) { options_.cog_height = height; }
  double height() const;

  /// The same for any number of threads. Any number of them may call it.
  GaitResult make(const GaitCell& cell, const Progress& progress) const;
  /// A walk from one cell to another.
  GaitResult change(const GaitCell& from, const GaitCell& to, const Progress& progress) const;

  /// The walk of a cell. `steps` moves, and one step more that brings the feet together.
  WalkParameters walk(const GaitCell& cell, int steps) const;
  /// Steps after which a walk has forgotten its start, or before which it does not know its end.
  int memory(double period) const;
  /// The same for the beginning, an even number, so that each cycle begins with the same foot.
  int lead(double period) const;

 private:
  struct Made;
  // These throw the reason why the walk is missing.
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
