#pragma once
// A readable version of the pattern that is being authored: its samples, its verdict, and what the
// live page shows of it.

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "ayumi/check/stability_series.hpp"
#include "ayumi/io/task_file.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::app {

using OrderedJson = nlohmann::ordered_json;

/// Rows per second of the tables that the page receives [Hz].
inline constexpr double kPageRate = 50;

struct AuthorMotion {
  Task task;
  Judgement judgement;
  OrderedJson document;  ///< of the text, as written
  SimulationLog plan;    ///< each tick of the page's tables
  std::string series;    ///< the page's table of the plan
  OrderedJson parts;     ///< members of the page's state that follow from the motion
};

/// Inputs besides the text of the pattern.
struct AuthorSetting {
  std::filesystem::path file;  ///< of the pattern
  std::map<std::string, double> set;
  std::string profile;  ///< "": the pattern's
};

/// Throws as pattern_of_text() and make_task().
std::shared_ptr<const AuthorMotion> author_motion(const std::string& text, const NamedRobot& robot,
                                                  const AuthorSetting& setting,
                                                  const Progress& progress = {});

/// The members of the page's state that follow from the text alone: its phases, keyframes, tracks
/// and disturbances, with their places.
OrderedJson author_structure(const Pattern& pattern, const OrderedJson& document);

/// What the strip of the page shows of a motion or a run of the task: { lanes, dt }.
OrderedJson author_strip(const Task& task, const StabilitySeries& stability);

/// The item of the pattern's list that holds a phase or keyframe: itself, or a block that repeats.
std::string outermost(const std::string& pointer);

/// The handles of the picture: the soles, the ends of the arms, the point that the head looks at,
/// the trunk and the COG.
struct AuthorHandle {
  enum class Kind { foot, limb, gaze, trunk, cog };
  Kind kind = Kind::cog;
  std::string name, label;
  int body = -1;                                    ///< -1: the COG
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< frame of the body [m]
  Side side = Side::left;                           ///< of a foot
  std::string link = {};                            ///< of a limb: its name in "hands"
};
std::vector<AuthorHandle> handles_of(const RobotModel& robot);

/// The target of a key for a hand, for another link, or for the gaze.
struct AuthorTarget {
  std::string pointer;         ///< of the key's value
  std::string label;           ///< "left hand"
  std::string handle;          ///< that follows it; empty: none
  double time = 0, until = 0;  ///< of the key, and until when it leads at most [s]
  Eigen::Vector3d place;       ///< at its time, world [m]
  Eigen::Matrix3d axes;        ///< of the written place, world
};
std::vector<AuthorTarget> targets_of(const AuthorMotion& motion);

}  // namespace ayumi::app
