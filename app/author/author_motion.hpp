#pragma once
// A readable version of the pattern that is being authored: its samples, its verdict, and what the
// live page shows of it.

#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/check/stability_series.hpp"
#include "ayumi/io/task_file.hpp"
#include "ayumi/render/robot_surface.hpp"
#include "ayumi/sim/simulation_log.hpp"

namespace ayumi::app {

using OrderedJson = nlohmann::ordered_json;

/// Rows per second of the tables that the page receives [Hz].
inline constexpr double kPageRate = 50;

struct AuthorMotion {
  Task task;
  Judgement judgement;
  OrderedJson document;  ///< document of the text, as written
  SimulationLog plan;    ///< each tick of the page's tables
  std::string series;    ///< the page's table of the plan
  OrderedJson parts;     ///< members of the page's state that follow from the motion
};

/// The robot of the pattern, and the triangles that are drawn of it.
struct ShownRobot {
  NamedRobot named;
  std::vector<BodySurface> surface;
};

/// Inputs besides the text of the pattern.
struct AuthorSetting {
  std::filesystem::path file;  ///< file of the pattern
  std::map<std::string, double> set;
  std::string profile;  ///< actuator profile; "" for that of the pattern
};

/// The message of an error without the name of the pattern's file and the line, because the page
/// only shows this file and shows the line itself.
std::string without_file(const Error& error, const std::filesystem::path& file);

/// Throws the same errors as pattern_of_text() and make_task().
std::shared_ptr<const AuthorMotion> author_motion(const std::string& text, const ShownRobot& robot,
                                                  const AuthorSetting& setting,
                                                  const Progress& progress = {});

/// The members of the page's state that follow from the text alone: its phases, keyframes, tracks
/// and disturbances, each with its place.
OrderedJson author_structure(const Pattern& pattern, const OrderedJson& document);

/// The strip of the page for a motion or a run of the task: { lanes, dt }.
OrderedJson author_strip(const Task& task, const StabilitySeries& stability);

/// The item of the pattern's list that contains a phase or keyframe: itself, or the block that
/// repeats it.
std::string outermost(const std::string& pointer);

/// The handles of the picture: the soles, the ends of the arms, the point that the head looks at,
/// the trunk and the COG.
struct AuthorHandle {
  enum class Kind { foot, limb, gaze, trunk, cog };
  Kind kind = Kind::cog;
  std::string name, label;
  int body = -1;                                    ///< index of the body; -1 for the COG
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< point in the frame of the body [m]
  Side side = Side::left;                           ///< the side of a foot
  std::string link = {};                            ///< the name of a limb in "hands"
};
std::vector<AuthorHandle> handles_of(const RobotModel& robot);

/// The target of a key for a hand, for another link, or for the gaze.
struct AuthorTarget {
  std::string pointer;         ///< pointer of the key's value
  std::string label;           ///< name for people, such as "left hand"
  std::string handle;          ///< handle that follows the target; empty if there is none
  double time = 0, until = 0;  ///< time of the key, and the time until which it leads at most [s]
  Eigen::Vector3d place;       ///< place at its time, in the world [m]
  Eigen::Matrix3d axes;        ///< axes in which the place is written, in the world
};
std::vector<AuthorTarget> targets_of(const AuthorMotion& motion);

}  // namespace ayumi::app
