#pragma once
// Data and functions that the parts of sample() share: the pattern as tracks, and postures from
// them.

#include <algorithm>
#include <atomic>

#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/progress.hpp"
#include "ayumi/dynamics/inverse_kinematics.hpp"
#include "ayumi/dynamics/tree_dynamics.hpp"
#include "ayumi/motion/command_series.hpp"
#include "ayumi/plan/link_plan.hpp"
#include "ayumi/plan/tracks.hpp"

namespace ayumi {

struct SampleJob {
  const RobotModel& model;
  const Pattern& pattern;
  const FootPlan& feet;
  const InverseKinematics& ik;
  const PatternTracks& tracks;
  const LinkPlan& links;
  double dt = 0.001;  ///< time between samples [s]
  int count = 0;      ///< number of samples
  int threads = 0;    ///< number of threads; 0 for all cores
  const Progress& progress;
  /// Whether a posture that is out of reach becomes the nearest posture; otherwise it is an error.
  bool nearest = false;
  /// Copied for each block of samples, because a copy is cheaper than a new one.
  const RobotData data = RobotData(model);
  const TreeDynamics dynamics = TreeDynamics(model);
};

/// Number of samples that one thread solves one after the other, each with the previous ones as its
/// initial guess. Chosen: the first few samples of a block cost more, and they are few in a block
/// of this size; there are still enough blocks for all cores. Figures change by rounding only.
inline constexpr int kBlock = 256;

/// Divides the numbers 0..count-1 into blocks of `block` numbers and calls work(first, end) for
/// each block, on the threads of the job. Reports the stage from time to time if there are very
/// many blocks. With `block` = 0, there is only one block.
template <class Work>
void in_blocks(const SampleJob& job, const char* stage, int count, int block, const Work& work) {
  // Blocks between two reports. Chosen: they take a fraction of a second.
  constexpr int kBlocksAtOnce = 128;
  if (block == 0) block = count;
  for (int begin = 0; begin < count; begin += kBlocksAtOnce * block) {
    if (begin > 0) report(job.progress, {stage, static_cast<double>(begin) / count, ""});
    const int end = std::min(count - begin, kBlocksAtOnce * block) + begin;
    const int blocks = (end - begin + block - 1) / block;
    std::atomic<bool> stop = false;
    in_parallel(static_cast<size_t>(blocks), job.threads, stop, [&](size_t i) {
      const int first = begin + static_cast<int>(i) * block;
      work(first, std::min(first + block, end));
    });
  }
}

/// Extrapolates the next one of a sequence of vectors at equal time steps from the last four, as an
/// initial guess.
class Extrapolation {
 public:
  void add(const Eigen::VectorXd& x);
  /// `guess` becomes the extrapolated vector, or the last vector if the sequence is discontinuous.
  /// Needs at least one vector.
  void next(Eigen::VectorXd& guess) const;

 private:
  const Eigen::VectorXd& before(int steps) const { return last_[(count_ - steps) % 4]; }

  std::array<Eigen::VectorXd, 4> last_;
  int count_ = 0;
};

/// theta of every joint track at t [rad].
Eigen::VectorXd keyed_joints(const SampleJob& job, double t);

/// Fills the planned feet, the support and the joints with tracks of their own; joints that follow
/// hands are not changed and serve as an initial guess.
void put_plan(const SampleJob& job, double t, CommandSample& sample);

/// Commanded trunk attitude: the torso keys or, without keys, level with the mean heading of the
/// planned feet.
Eigen::Matrix3d trunk_attitude(const SampleJob& job, double t,
                               const std::array<Eigen::Isometry3d, 2>& feet);

/// Turn of the trunk from this attitude around flights (flight.hpp): a rotation vector over time,
/// world axes, left-multiplied [rad].
using TrunkTurn = std::array<Track, 3>;

/// The base relative to the COG, and the joints, as one vector for Extrapolation.
Eigen::VectorXd posture_of(const CommandSample& sample);

/// Makes the initial guess of sample.state from the previous postures and sample.cog.
void continue_posture(const Extrapolation& postures, CommandSample& sample);

/// Solves base and legs at time t for sample.cog and the plan in `sample`, with the initial guess
/// sample.state. Out of reach, throws Error(bad_pattern) that names phase, time, foot and missing
/// millimetres, or takes the nearest posture (SampleJob::nearest).
PostureSolution solve_posture(const SampleJob& job, double t, const Eigen::Matrix3d& trunk,
                              CommandSample& sample, RobotData& data);

/// Whether any phase has no support.
bool flies(const SampleJob& job);

/// Fraction of the weight. Where the vertical ground force is smaller, the ZMP has no meaning (see
/// (17)), so its error is neither counted nor corrected. Chosen: 5 %, as in motion/differentiate.
/// No measured case changes between half and twice the value (constants.md).
inline constexpr double kZmpShare = 0.05;

/// COG and ZMP of a motion driven by the body's tracks.
struct CogPlan {
  std::array<Track, 3> cog;                     ///< COG in the world [m]
  std::array<Track, 3> zmp;                     ///< ZMP in the world, as the keys state it [m]
  std::array<bool, 2> solved = {false, false};  ///< whether an axis is solved from the ZMP
  std::array<Eigen::Vector2d, 2> bump = {
      Eigen::Vector2d::Zero(), Eigen::Vector2d::Zero()};  ///< bumps at both ends by axis [m]
  std::array<Eigen::Vector2d, 2> omega = {
      Eigen::Vector2d::Ones(), Eigen::Vector2d::Ones()};  ///< omega at both ends by axis [1/s]
  TrunkTurn turn;
  double duration = 0;  ///< duration of the pattern [s]
  /// Postures on a grid from beginning to end that are close to those of the motion and serve as
  /// initial guesses; may be empty.
  std::vector<RobotState> postures;

  Eigen::Vector3d cog_at(double t) const;
  /// The commanded ZMP: that of the keys, with the bumps that a start from rest needs.
  Eigen::Vector3d zmp_at(double t) const;
  /// The attitude `asked` of the trunk, with the turn that is added in and near flights.
  Eigen::Matrix3d turned(double t, const Eigen::Matrix3d& asked) const;
};

/// The COG from its keys. Without keys, it comes from the ZMP by (14)(15) and is corrected for the
/// full model.
CogPlan plan_cog(const SampleJob& job);

/// Computes the commanded ZMP and f_z of a sample whose COG rates are already known.
void put_ground_commands(const SampleJob& job, const CogPlan& plan, double t,
                         CommandSample& sample);

/// Throws Error(bad_pattern) for a flight without the keys that its parabola needs.
void require_body_tracks(const SampleJob& job);

/// The motion when base and legs follow COG and feet.
CommandSeries sample_body_driven(const SampleJob& job);

/// The motion when keys or a table drive the legs.
CommandSeries sample_joint_driven(const SampleJob& job);

/// A length as text, such as "0.42 mm".
std::string millimetres(double metres);

}  // namespace ayumi
