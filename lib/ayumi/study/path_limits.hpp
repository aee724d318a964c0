#pragma once
// The limits of a motion along its path. If the motion is played with s'(t) instead of s' = 1, the
// same postures have
//   dq = q_s s',   ddq = q_s s'' + q_ss s'^2,
// so that inverse dynamics is F = F_0 + F_u u + F_x x with u = s'' and x = s'^2. The rows of all
// limits of rates and forces that a repair keeps (limits/row.hpp) become rows in (u, x). Rows of
// accelerations and of the linear parts of the ground wrench become so exactly; the others are
// replaced by their tangents at the timing of the round before.

#include <string>
#include <vector>

#include "ayumi/limits/row_site.hpp"
#include "ayumi/math/path_timing.hpp"
#include "ayumi/study/pauses.hpp"

namespace ayumi {

struct PathLimitOptions {
  CheckOptions check;
  double spacing = 0.01;  ///< spacing of the points on the path [s]
  double own_margin =
      0.8;  ///< share of the ZMP's margin at the path's own pace that the timing keeps
  double least_margin = 0;          ///< margin that is kept if this share is smaller [m]
  double most_margin = kUnbounded;  ///< largest margin that is kept [m]
  double most_pace = 4;             ///< largest s'
  std::vector<TimeSpan> pauses;     ///< windows of the path in which s' is at most 1 [s]
};

/// A limit that decides a timing, and the share of the time for which it does so.
struct BindingLimit {
  std::string
      limit;  ///< name of its rows; "pace" for the largest s'; "pause"; "" if no limit is active
  double share = 0;  ///< share of the duration
};

/// A row of one point with its origin.
struct PathRow {
  const RowKind* kind = nullptr;
  int item = 0;  ///< the same number as RowBlock::item
  TimingRow row;
};

class PathLimits {
 public:
  /// `series` is the path. Model and series must outlive this object.
  PathLimits(const RobotModel& model, const CommandSeries& series, const PathLimitOptions& options);

  /// The points of the path. They have rows after linearize().
  const std::vector<TimingPoint>& points() const { return timing_; }

  /// Makes the rows about a timing with these u and x by point. `share` says for each point how
  /// much of the distance between standing still and a limit may be used. In a motion with a
  /// flight, bounds are raised where necessary, so that the path's own pace (u = 0, x = 1)
  /// satisfies all rows; no other pace is possible in flight.
  void linearize(const std::vector<double>& u, const std::vector<double>& x,
                 const std::vector<double>& share);

  /// The rows of points()[point] and their origins. Limits of speed have no rows; they are bounds
  /// of x.
  std::vector<PathRow> rows_at(int point) const;
  /// The index of the sample of the path that is points()[point].
  int sample_of(int point) const { return sites_[static_cast<size_t>(point)].sample; }

  bool flies() const { return flies_; }

  /// The values that the path allows if it is played at one pace.
  struct UniformPace {
    bool keeps = false;  ///< whether the path satisfies all rows at its own pace
    double pace = 0;     ///< the largest pace that satisfies all rows except those of the ZMP
  };
  UniformPace uniform_pace();

  /// The rows that are active for a timing with these times by point; the one with the largest
  /// share comes first.
  std::vector<BindingLimit> binding(const std::vector<double>& u, const std::vector<double>& x,
                                    const std::vector<double>& times) const;

  /// Names of the rows that a robot at rest violates at a point.
  std::string broken_at(int point) const;

 private:
  struct Forces {
    Eigen::VectorXd rest, of_u, of_x;
  };

  void place_points(const PathLimitOptions& options);
  void place_rows();
  void compute_forces();
  void linearize_point(size_t i, double u, double x, double share, RobotData& data);
  template <class Work>
  void for_each_point(const Work& work) const;

  const RobotModel& model_;
  const CommandSeries& series_;
  const PathLimitOptions options_;
  const ActuatorLimits& actuators_;
  const ContactPlan plan_;
  bool flies_ = false;
  std::vector<CollocationPoint> sites_;
  std::vector<char> fixed_;   ///< by point: s' is 1 in flight and near it
  std::vector<char> paused_;  ///< by point: it lies in a pause
  std::vector<RowBlock> rows_;
  std::vector<std::vector<const RowBlock*>> rows_of_;  ///< rows by point, from rows_
  std::vector<Forces> forces_;                         ///< forces by point
  std::vector<TimingPoint> timing_;
  std::vector<std::vector<const RowBlock*>> origins_;  ///< origins of the rows in timing_
  std::vector<const RowKind*> cap_;  ///< by point, the limit that bounds x; null if there is none
};

}  // namespace ayumi
