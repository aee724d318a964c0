#pragma once
// A pattern as its author writes it: keyframes on tracks, contact phases, controller and scenario.
// Plain data in SI units and radians (the file states its own angle unit). docs/formats.md
// specifies the file.

#include <Eigen/Geometry>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/math/track.hpp"
#include "ayumi/model/robot_model.hpp"
#include "ayumi/motion/controller_spec.hpp"
#include "ayumi/motion/scenario.hpp"
#include "ayumi/motion/uncertainty.hpp"
#include "ayumi/motion/viip_goal.hpp"

namespace ayumi {

enum class Support { both, left, right, none };
const char* name_of(Support support);
inline bool supports(Support support, Side side) {
  return support == Support::both ||
         support == (side == Side::left ? Support::left : Support::right);
}
/// The mirror image: left and right are exchanged.
inline Support opposite(Support support) {
  return support == Support::left    ? Support::right
         : support == Support::right ? Support::left
                                     : support;
}

const char* name_of(Interpolation interpolation);

/// A foothold: pose of the sole frame in the world.
struct Foothold {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();       ///< roll, pitch, yaw, R = Rz Ry Rx [rad]
};

/// A step as seen from the sole frame of the other foot. If all values are 0, the foot lands beside
/// the other one, with the distance and the turn that it has at the start.
struct RelativeStep {
  double forward = 0, side = 0, up = 0;  ///< ahead, to the left, upwards [m]
  double turn = 0;                       ///< to the left [rad]
};

/// The foot that moves during a phase, and where it lands.
struct Swing {
  Side foot = Side::left;
  Foothold to;         ///< unused with a step
  double lift = 0.02;  ///< height of the sole at mid-swing above the line between footholds [m]
  std::optional<RelativeStep> step = {};
};

/// The feet that carry the robot until `until`; phases follow each other from t = 0.
struct Phase {
  double until = 0;  ///< [s]
  Support support = Support::both;
  std::optional<Swing> swing;
  std::optional<ViipGoal> viip = {};  ///< VIIP controls the robot: a goal in place of keys
  std::string pointer = {};           ///< JSON pointer of its source in the file; empty: of none
};

/// A ZMP key: a place under the supporting feet, or a point on the ground.
struct ZmpKey {
  enum class Place { left, right, center, point };
  Place place = Place::point;  ///< left/right: centre of that sole at that time
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< world [m], for Place::point
};
/// The mirror image: left and right are exchanged.
inline ZmpKey::Place opposite(ZmpKey::Place place) {
  return place == ZmpKey::Place::left    ? ZmpKey::Place::right
         : place == ZmpKey::Place::right ? ZmpKey::Place::left
                                         : place;
}

/// Target of the end of a link: its place and its direction; or the point that a head looks at.
struct LinkTarget {
  enum class Frame { world, trunk };
  Frame frame = Frame::world;
  std::optional<Eigen::Vector3d> position;   ///< none: the keys of the joints lead the link again
  std::optional<Eigen::Vector3d> direction;  ///< from the link's joint to its end, unit vector
};

/// Sets the tracks that it names at time t, and no other tracks.
struct Keyframe {
  double t = 0;                                ///< [s]
  std::optional<Interpolation> interpolation;  ///< of the segment that ends here
  std::optional<std::string> posture;          ///< named posture of the robot
  std::map<std::string, double> joints;        ///< by joint name [rad]
  std::optional<ZmpKey> zmp;
  std::optional<double> cog_x, cog_y, cog_height;  ///< world [m]
  std::optional<double> fz;                        ///< [N]
  std::optional<Eigen::Vector3d> torso;            ///< roll, pitch, yaw in the world [rad]
  std::array<std::optional<Foothold>, 2> feet;     ///< by Side, world
  std::map<std::string, LinkTarget> hands;         ///< by "left", "right" or the name of a link
  std::optional<LinkTarget> gaze;                  ///< the point that the head looks at
  std::map<std::string, double> weights;           ///< diagonal of W by joint name
  SourcePlace place;                               ///< in the file, for messages
  std::string pointer = {};                        ///< JSON pointer of its source; empty: of none
};

/// The file of targets from which a table was imported, kept beside the table.
struct KeptSequence {
  std::string file;          ///< as the head of the table names it, or an absolute path
  std::string sha256;        ///< of its bytes
  std::string theta_sha256;  ///< of the angles that the import made of it (DenseTable::theta)
};

/// A sampled motion in a file beside the pattern: all columns of the file, at a fixed rate.
struct DenseTable {
  std::string file;                           ///< as the pattern names it
  double dt = 0.001;                          ///< [s]
  std::vector<std::string> joints;            ///< columns of theta
  Eigen::MatrixXd theta;                      ///< rows x joints [rad]
  bool commands = false;                      ///< theta are servo targets, not the posture
  std::vector<BasePose> base;                 ///< empty or one per row
  std::vector<Eigen::Vector3d> cog, zmp;      ///< empty or one per row, world [m]
  std::vector<double> fz;                     ///< empty or one per row [N]
  std::optional<KeptSequence> sequence = {};  ///< of an imported table
  int interval_ms = 0;  ///< from row to row of the file that was imported; 0: none was [ms]
};

/// A smooth change that is added to the sampled motion, as a repair writes it: uniform cubic
/// B-splines in time. Column order: base x y z [m], base rotation vector (world axes,
/// left-multiplied) [rad], joints.
struct CorrectionTrack {
  double begin = 0;                 ///< [s]
  double spacing = 0;               ///< of the knots [s]
  std::vector<std::string> joints;  ///< names of columns 6...
  Eigen::MatrixXd coefficients;     ///< control points x (6 + joints)
};

/// The commanded quantity that a repair keeps and that the others have to follow. COG, ZMP and f_z
/// that are not trusted become those of the full model.
enum class Trust { posture, cog, zmp };
const char* name_of(Trust trust);

/// The author's preferences for a repair; the caller of the repair decides what is left out.
struct RepairPreferences {
  std::vector<std::string> joints;                 ///< locked: bit-identical
  std::array<bool, 2> feet = {};                   ///< locked, by Side: the feet keep their path
  std::vector<int> keyframes;                      ///< locked: nothing changes at their times
  std::vector<std::pair<double, double>> windows;  ///< locked: nothing changes in them [s]
  std::map<std::string, double> weights;           ///< factors on the cost of a joint
  std::optional<Trust> trust;
  std::optional<double> margin;  ///< wanted ZMP distance from the support's edge [m]
  std::optional<double> safety;  ///< factor on the robustness cost; 0: smallest change alone

  bool empty() const;
};

struct Pattern {
  std::string name;
  std::string file;     ///< source, for messages
  std::string sha256;   ///< of its bytes, then of its includes and its table
  std::string schema;   ///< "$schema" as written, for editors; may be empty
  std::string robot;    ///< name or path as written
  std::string profile;  ///< actuator profile; "" = the robot's default
  bool degrees = true;  ///< angle unit of the file; everything here is in rad
  Interpolation interpolation = Interpolation::minimum_jerk;
  std::string default_posture = "home";
  bool full_model = true;  ///< COG from ZMP keys for the full model, else (14)(15)
  double cog_height = 0;   ///< constant COG height without keys; 0: that of home [m]
  std::array<std::optional<Foothold>, 2>
      start_feet;  ///< by Side; else the feet of the default posture
  std::vector<Phase> phases;
  std::vector<Keyframe> keyframes;
  std::map<std::string, std::map<std::string, double>>
      postures;  ///< of the pattern and its includes;
                 ///< they take precedence over the robot's [rad]
  std::optional<DenseTable> table;
  std::optional<CorrectionTrack> correction;
  std::map<std::string, double> parameters;  ///< declared ${names} with their values
  std::map<std::string, double> tolerances;  ///< of the check, by finding kind
  RepairPreferences repair;
  World world;  ///< the ground under the robot
  ControllerSpec controller;
  std::vector<Disturbance> scenario;
  Uncertainty uncertainty;  ///< under which the pattern is certified; empty: that of the robot

  double duration() const;  ///< end of the last phase, keyframe or table row [s]
};

}  // namespace ayumi
