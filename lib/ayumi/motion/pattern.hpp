#pragma once
// A pattern as its author writes it: keyframes on tracks, contact phases, controller and scenario.
// It is plain data in SI units and radians (the file states its own angle unit). docs/formats.md
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

/// A foothold, which is a pose of the sole frame in the world.
struct Foothold {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< position [m]
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();  ///< roll, pitch and yaw, with R = Rz Ry Rx [rad]
};

/// A step as seen from the sole frame of the other foot. If all values are 0, the foot lands beside
/// the other one, with the distance and the turn that it has at the start.
struct RelativeStep {
  double forward = 0, side = 0, up = 0;  ///< distance ahead, to the left and upwards [m]
  double turn = 0;                       ///< turn to the left [rad]
};

/// The foot that moves during a phase, and where it lands.
struct Swing {
  Side foot = Side::left;
  Foothold to;         ///< place of landing; unused if a step is given
  double lift = 0.02;  ///< height of the sole at mid-swing above the line between footholds [m]
  std::optional<RelativeStep> step = {};
};

/// The feet that carry the robot until `until`; phases follow each other from t = 0.
struct Phase {
  double until = 0;  ///< end of the phase [s]
  Support support = Support::both;
  std::optional<Swing> swing;
  /// The goal with which VIIP controls the robot instead of keys.
  std::optional<ViipGoal> viip = {};
  /// JSON pointer of its source in the file; empty if it is from no file.
  std::string pointer = {};
};

/// A ZMP key: a place under the supporting feet, or a point on the ground.
struct ZmpKey {
  enum class Place { left, right, center, point };
  Place place = Place::point;  ///< left/right: the centre of that sole at that time
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< point in the world [m], for Place::point
};
/// The mirror image: left and right are exchanged.
inline ZmpKey::Place opposite(ZmpKey::Place place) {
  return place == ZmpKey::Place::left    ? ZmpKey::Place::right
         : place == ZmpKey::Place::right ? ZmpKey::Place::left
                                         : place;
}

/// The target of the end of a link, as its place and its direction, or the point that a head looks
/// at.
struct LinkTarget {
  enum class Frame { world, trunk };
  Frame frame = Frame::world;
  /// Place of the end; without it, the link follows the keys of its joints again.
  std::optional<Eigen::Vector3d> position;
  std::optional<Eigen::Vector3d> direction;  ///< unit vector from the link's joint to its end
};

/// A keyframe sets the tracks that it names at time t, and no other tracks.
struct Keyframe {
  double t = 0;                                ///< time [s]
  std::optional<Interpolation> interpolation;  ///< interpolation of the segment that ends here
  std::optional<std::string> posture;          ///< name of a posture of the robot
  std::map<std::string, double> joints;        ///< positions by joint name [rad]
  std::optional<ZmpKey> zmp;
  std::optional<double> cog_x, cog_y, cog_height;  ///< COG in the world [m]
  std::optional<double> fz;                        ///< vertical force [N]
  std::optional<Eigen::Vector3d> torso;  ///< roll, pitch and yaw of the torso in the world [rad]
  std::array<std::optional<Foothold>, 2> feet;  ///< footholds by Side, in the world
  std::map<std::string, LinkTarget> hands;  ///< targets by "left", "right" or the name of a link
  std::optional<LinkTarget> gaze;           ///< the point that the head looks at
  std::map<std::string, double> weights;    ///< diagonal of W, by joint name
  SourcePlace place;                        ///< place in the file, for messages
  std::string pointer = {};  ///< JSON pointer of its source; empty if it is from no file
};

/// The file of targets from which a table was imported, which is kept beside the table.
struct KeptSequence {
  std::string file;    ///< name in the head of the table, or an absolute path
  std::string sha256;  ///< checksum of its bytes
  /// Checksum of the angles that the import made of it (DenseTable::theta).
  std::string theta_sha256;
};

/// A sampled motion in a file beside the pattern: all columns of the file, at a fixed rate.
struct DenseTable {
  std::string file;                           ///< name in the pattern
  double dt = 0.001;                          ///< time between rows [s]
  std::vector<std::string> joints;            ///< names of the columns of theta
  Eigen::MatrixXd theta;                      ///< joint positions, rows x joints [rad]
  bool commands = false;                      ///< theta holds servo targets instead of the posture
  std::vector<BasePose> base;                 ///< empty or one per row
  std::vector<Eigen::Vector3d> cog, zmp;      ///< places in the world [m]; empty or one per row
  std::vector<double> fz;                     ///< vertical force [N]; empty or one per row
  std::optional<KeptSequence> sequence = {};  ///< source of an imported table
  int interval_ms = 0;  ///< time between rows of the imported file [ms]; 0 if none was imported
  /// Identity of the encoders with which the file was read (encoders_of()); "" if no file is kept.
  std::string encoders = {};
};

/// A time in which the sampled motion is replaced by smooth curves (motion/smooth_motion.hpp).
struct SmoothWindow {
  double begin = 0, end = 0;  ///< beginning and end [s]
  double spacing = 0;         ///< time between the knots of the curves [s]
};

/// A smooth change that is added to the sampled motion, as a repair writes it: uniform cubic
/// B-splines in time. The columns are: base x y z [m], the rotation vector of the base (world axes,
/// left-multiplied) [rad], and the joints.
struct CorrectionTrack {
  double begin = 0;                 ///< start of the track [s]
  double spacing = 0;               ///< time between knots [s]
  std::vector<std::string> joints;  ///< names of the columns from 6 on
  Eigen::MatrixXd coefficients;     ///< control points x (6 + joints)
  /// Windows in which the motion is made smooth before the change is added.
  std::vector<SmoothWindow> smooth = {};
};

/// The commanded quantity that a repair keeps and that the others have to follow. COG, ZMP and f_z
/// that are not trusted are replaced by those of the full model.
enum class Trust { posture, cog, zmp };
const char* name_of(Trust trust);

/// The author's preferences for a repair. The caller of the repair chooses the values that are not
/// stated here.
struct RepairPreferences {
  std::vector<std::string> joints;  ///< locked joints, which stay bit-identical
  std::array<bool, 2> feet = {};    ///< locked feet, by Side, which keep their path
  std::vector<int> keyframes;       ///< locked keyframes, at whose times nothing changes
  std::vector<std::pair<double, double>> windows;  ///< locked windows, in which nothing changes [s]
  std::map<std::string, double> weights;           ///< factors on the cost of joints, by name
  std::optional<Trust> trust;
  std::optional<double> margin;  ///< wanted distance of the ZMP from the support's edge [m]
  /// Factor on the robustness cost; with 0, only the change is kept small.
  std::optional<double> safety;

  bool empty() const;
};

struct Pattern {
  std::string name;
  std::string file;     ///< name of the source, for messages
  std::string sha256;   ///< checksum of its bytes, then those of its includes and its table
  std::string schema;   ///< "$schema" as written, for editors; may be empty
  std::string robot;    ///< name or path of the robot as written
  std::string profile;  ///< actuator profile; "" for the robot's default
  bool degrees = true;  ///< angle unit of the file is degrees; all angles here are in rad
  Interpolation interpolation = Interpolation::minimum_jerk;
  std::string default_posture = "home";
  /// The COG follows from ZMP keys by the full model, otherwise by (14)(15).
  bool full_model = true;
  double cog_height = 0;  ///< constant COG height if there are no keys; 0 for that of home [m]
  std::array<std::optional<Foothold>, 2>
      start_feet;  ///< start footholds by Side; without them, the feet of the default posture
  std::vector<Phase> phases;
  std::vector<Keyframe> keyframes;
  /// Postures of the pattern and its includes, which take precedence over the robot's [rad].
  std::map<std::string, std::map<std::string, double>> postures;
  std::map<std::string, std::string> posture_files = {};  ///< files of the included postures
  std::optional<DenseTable> table;
  std::optional<CorrectionTrack> correction;
  std::map<std::string, double> parameters;  ///< declared ${names} with their values
  std::map<std::string, double> tolerances;  ///< tolerances of the check, by kind of finding
  RepairPreferences repair;
  World world;  ///< the ground under the robot
  ControllerSpec controller;
  std::vector<Disturbance> scenario;
  /// Uncertainty under which the pattern is certified; if empty, that of the robot.
  Uncertainty uncertainty;

  double duration() const;  ///< end of the last phase, keyframe or table row [s]
};

}  // namespace ayumi
