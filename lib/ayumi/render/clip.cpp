#include "ayumi/render/clip.hpp"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "ayumi/base/file.hpp"
#include "ayumi/base/in_parallel.hpp"
#include "ayumi/base/shortened_text.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/render/encoder.hpp"
#include "ayumi/render/hidden_parts.hpp"
#include "ayumi/render/log_reading.hpp"
#include "ayumi/render/robot_look.hpp"
#include "ayumi/render/simplify.hpp"

namespace ayumi {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

// Largest number of frames of a clip. Chosen: nine hours at 30 frames per second. More are a slip
// in the speed or in the frames per second.
constexpr double kMostFrames = 1e6;

double frames_of(const SimulationLog& log, const ClipOptions& options) {
  const double end = options.end < 0 ? duration(log) : std::min(options.end, duration(log));
  const double step = options.speed / options.fps;
  return std::floor((end - options.begin) / step + 1e-6) + 1;
}

void check(const RobotModel& model, const SimulationLog& log, const ClipOptions& options) {
  const double last = duration(log);
  const auto need = [](bool good, const std::string& what) {
    if (!good) fail(ErrorCode::usage, what);
  };
  need(log.samples.front().state.theta.size() == model.dof_count(),
       "the run has " + std::to_string(log.samples.front().state.theta.size()) +
           " joints, but the robot " + model.name() + " has " + std::to_string(model.dof_count()) +
           "; name the robot of the run");
  if (options.ghost.log) {
    duration(*options.ghost.log);
    need(options.ghost.log->joints == log.joints,
         "ghost: the other run has other joints, so it is a run of another robot; choose a run of "
         "the same robot");
  }
  need(!options.ghost.command || log.samples.front().command_theta.size() == model.dof_count(),
       "ghost: the log does not hold the commanded posture; simulate again");
  need(
      options.fps > 0 && options.fps <= 1000,
      "fps: " + text::exact(options.fps) + " is not possible; give a number above 0, at most 1000");
  require_within("the number of threads", options.threads, kThreadBounds);
  need(options.speed > 0 && std::isfinite(options.speed),
       "speed: " + text::exact(options.speed) + " is not possible; give a number above 0");
  need(options.begin >= 0 && options.begin <= last,
       "the first time, " + text::exact(options.begin) + " s, is outside the run (0 to " +
           text::brief(last) + " s)");
  need(options.end < 0 || options.end >= options.begin,
       "the last time, " + text::exact(options.end) + " s, is before the first time, " +
           text::exact(options.begin) + " s");
  const double frames = frames_of(log, options);
  need(frames <= kMostFrames, "the clip would have " + text::brief(frames) +
                                  " frames, and at most " + text::brief(kMostFrames) +
                                  " are possible; choose a larger speed or fewer frames per "
                                  "second");
  const double at = options.at.value_or(0);
  need(at >= 0 && at <= last + 1e-9, "the time of the picture, " + text::exact(at) +
                                         " s, is outside the run (0 to " + text::brief(last) +
                                         " s)");
}

double robot_height(const std::vector<BodySurface>& surface, const RobotModel& model,
                    const SimulationLog& log) {
  const SimulationSample& first = log.samples.front();
  const Eigen::AlignedBox3d box = robot_bounds(surface, body_poses(model, first.state));
  if (box.isEmpty()) return 1.0;
  // If nothing is drawn above the COG, the height follows from the COG, around which the camera
  // looks.
  const double around_cog = 1.8 * (first.cog.z() - box.min().z());
  return std::max({1e-3, box.sizes().maxCoeff(), around_cog});
}

/// The points of each body that are farthest in 26 directions.
std::vector<std::vector<Vector3d>> outlines(const std::vector<BodySurface>& surface) {
  std::vector<std::vector<Vector3d>> all;
  for (const BodySurface& body : surface) {
    std::vector<Vector3d> points;
    for (int code = 0; code < 27; ++code) {
      const Eigen::Vector3f along(float(code % 3) - 1, float(code / 3 % 3) - 1,
                                  float(code / 9) - 1);
      if (along.isZero()) continue;
      float most = -INFINITY;
      Eigen::Vector3f farthest = Eigen::Vector3f::Zero();
      for (const Triangles* part : parts_of(body))
        for (const RenderVertex& vertex : part->vertices)
          if (along.dot(vertex.position) > most) {
            most = along.dot(vertex.position);
            farthest = vertex.position;
          }
      if (most > -INFINITY) points.emplace_back(farthest.cast<double>());
    }
    all.push_back(std::move(points));
  }
  return all;
}

/// Notes about everything that is drawn differently from the robot's files.
std::vector<std::string> notes_of(const RobotModel& model, const RobotLook& look, size_t drawn,
                                  double moved) {
  std::vector<std::string> notes;
  if (!has_visuals(model))
    notes.emplace_back(
        "the robot has no visual meshes. Its links are drawn with their collision shapes, and "
        "links "
        "without collision shapes as sticks between joints");
  else if (const int count = count_substitutes(model); count > 0)
    notes.push_back(
        std::to_string(count) + " of the robot's " + std::to_string(model.bodies().size()) +
        " bodies have no visual shapes. These bodies are drawn with their collision shapes, or as "
        "sticks between joints");
  if (moved > 0) notes.push_back(words_of(look, drawn, moved));
  return notes;
}

/// Everything that stands on the floor, and the place where a field replaces the plane.
Scenery scenery_of(const SimulationLog& log) {
  Scenery scenery = {make_scenery(log.world), {}};
  for (const HeightField& field : log.world.fields) {
    const Eigen::Vector2d size(double(field.heights.rows() - 1), double(field.heights.cols() - 1));
    scenery.hole = {field.origin, field.origin + field.spacing * size};
  }
  return scenery;
}

CameraPath make_path(const SimulationLog& log, const ClipOptions& options, double height) {
  std::vector<Vector3d> cog;
  for (const SimulationSample& sample : log.samples) cog.push_back(sample.cog);
  return {options.camera, std::move(cog), log.dt, height,
          double(options.picture.width) / options.picture.height};
}

std::string verdict_text(const SimulationResult& result) {
  if (result.outcome == Outcome::fell) return "fell at " + text::fixed(result.fell_at, 2) + " s";
  return result.outcome == Outcome::stands ? "stands" : "unsettled";
}

std::string law_name(const ControllerType& law) {
  return law == ControllerKind::none ? std::string("open loop") : std::string(name_of(law));
}

/// The name of a file without folder and extension.
std::string plain_name(const std::string& file) { return fs::path(file).stem().string(); }

/// Largest number of triangles of a robot in a clip. If there are more, the robot is thinned with
/// up to four times the tolerance, and it is simplified if there are still more. Chosen: they take
/// about 25 ms of a frame, which is 1 s for each second of motion, and half of them face the eye,
/// about one for three pixels. With half of the value, corners of noisy meshes are several pixels
/// apart; with twice, clips of robots with such meshes take 1 s longer.
constexpr size_t kMostOfClip = 80'000;
/// Smallest number of frames for which the robot of a clip is thinned. Chosen: thinning a robot
/// with 280,000 triangles takes 0.3 s, which about five frames save. With half of the value, clips
/// of half a second gain too; with twice, clips of a second gain nothing.
constexpr int kThinFrames = 24;

/// Longest wait for a frame before the caller may stop the work. Chosen: Ctrl-C is answered at
/// once, and the wait costs nothing.
constexpr std::chrono::milliseconds kFrameWait(50);

/// Largest number of threads that draw a clip. Chosen: one encoder can keep up with about this
/// number of threads, and each thread takes 40 MB. With half of the value, a machine of 16 cores
/// draws half as fast; with twice, a clip takes 1.3 GB.
constexpr int kMostClipThreads = 16;

/// Frames 0..count-1 in order, from `threads` workers that each own a renderer. At most two
/// finished frames wait per worker, so that memory does not grow with the clip.
class FrameQueue {
 public:
  using MakeRenderer = std::function<std::unique_ptr<ClipRenderer>()>;
  FrameQueue(int threads, int count, MakeRenderer make, std::function<double(int)> time) {
    const int workers = std::clamp(std::min(threads, kMostClipThreads), 1, std::max(1, count));
    slots_ = std::vector<Slot>(static_cast<size_t>(workers));
    const auto work = [this, workers, count, make, time](int w) {
      Slot& slot = slots_[size_t(w)];
      try {
        const std::unique_ptr<ClipRenderer> renderer = make();
        if (w == 0) {
          const std::lock_guard lock(mutex_);
          notes_ = renderer->notes();
        }
        for (int k = w; k < count; k += workers) {
          renderer->reuse(used_frame(slot));
          if (!put(slot, renderer->clip_frame(time(k)))) return;
        }
      } catch (...) {
        const std::lock_guard lock(mutex_);
        slot.error = std::current_exception();
        changed_.notify_all();
      }
    };
    try {
      for (int w = 0; w < workers; ++w) threads_.emplace_back(work, w);
    } catch (...) {  // there is no further thread, or no memory for one
      end();
      throw;
    }
  }
  ~FrameQueue() { end(); }
  FrameQueue(const FrameQueue&) = delete;
  FrameQueue& operator=(const FrameQueue&) = delete;

  /// Notes about what the renderers draw differently from the request. They are known when the
  /// first frame has been taken.
  const std::vector<std::string>& notes() const { return notes_; }

  /// While it waits, `alive` is called several times per second. An exception of `alive` ends the
  /// wait.
  Image take(int k, const std::function<void()>& alive) {
    Slot& slot = slots_[size_t(k) % slots_.size()];
    std::unique_lock lock(mutex_);
    const auto there = [&] { return !slot.ready.empty() || slot.error; };
    while (!changed_.wait_for(lock, kFrameWait, there)) alive();
    if (slot.ready.empty()) std::rethrow_exception(slot.error);
    Image image = std::move(slot.ready.front());
    slot.ready.erase(slot.ready.begin());
    changed_.notify_all();
    return image;
  }

  /// Gives the memory of a frame back to the worker that draws frame k and its successors.
  void give_back(int k, Image image) {
    const std::lock_guard lock(mutex_);
    slots_[size_t(k) % slots_.size()].used = std::move(image);
  }

 private:
  void end() {
    {
      const std::lock_guard lock(mutex_);
      stop_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  struct Slot {
    std::vector<Image> ready;
    Image used;
    std::exception_ptr error;
  };

  Image used_frame(Slot& slot) {
    const std::lock_guard lock(mutex_);
    return std::exchange(slot.used, {});
  }

  bool put(Slot& slot, Image image) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return slot.ready.size() < 2 || stop_; });
    if (stop_) return false;
    slot.ready.push_back(std::move(image));
    changed_.notify_all();
    return true;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool stop_ = false;
  std::vector<std::string> notes_;
  std::vector<Slot> slots_;
  std::vector<std::thread> threads_;
};

std::string frame_name(int k) {
  const std::string number = std::to_string(k);
  return "frame_" + std::string(number.size() < 5 ? 5 - number.size() : 0, '0') + number + ".png";
}

/// A message with the name that the user gave instead of the temporary name.
std::string with_name(std::string message, const std::string& temporary, const std::string& name) {
  for (size_t at; (at = message.find(temporary)) != std::string::npos;)
    message.replace(at, temporary.size(), name);
  return message;
}

/// Whether a file comes from a clip: its name is frame_name() of some number.
bool is_frame(const fs::directory_entry& entry) {
  const std::string name = entry.path().filename().string();
  const size_t begin = name.find_first_of("0123456789");
  const size_t end = name.find_first_not_of("0123456789", begin);
  if (!fs::is_regular_file(entry.symlink_status()) || end == std::string::npos) return false;
  int number = 0;
  const auto read = std::from_chars(name.data() + begin, name.data() + end, number);
  return read.ec == std::errc() && name == frame_name(number);
}

/// Throws unless frames may be written to a folder of that name: the folder does not exist, is
/// empty, or, if it may be overwritten, contains only frames.
void require_frame_folder(const fs::path& path, bool overwrite) {
  const fs::file_status status = fs::symlink_status(path);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) {
    require_file_target(path);
    refuse_existing(path);
  }
  for (const auto& entry : fs::directory_iterator(path))
    if (!overwrite || !is_frame(entry)) refuse_existing(path);
}

/// Fills a new folder beside `path`, and then renames it.
void write_folder(const fs::path& path, bool overwrite,
                  const std::function<void(const fs::path&)>& produce) {
  require_frame_folder(path, overwrite);
  const fs::path parent = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(parent))
    fail(ErrorCode::bad_file, {path.string()},
         "the folder " + parent.string() + " does not exist; create it first");
  const fs::path temporary =
      parent / (path.filename().string() + ".part" + std::to_string(::getpid()));
  std::error_code error, ignored;
  if (!fs::create_directory(temporary, error))
    fail(ErrorCode::bad_file, {path.string()},
         "the folder cannot be written (" +
             (error ? error.message() : temporary.string() + " already exists") + ")");
  try {
    produce(temporary);
    require_frame_folder(path, overwrite);
    if (fs::exists(path)) fs::remove_all(path);
    fs::rename(temporary, path);
  } catch (const fs::filesystem_error& error) {
    fs::remove_all(temporary, ignored);
    fail(ErrorCode::bad_file, {path.string()},
         "the folder cannot be written (" + error.code().message() + ")");
  } catch (const Error& error) {
    fs::remove_all(temporary, ignored);
    throw Error(error.code(), with_name(error.what(), temporary.string(), path.string()),
                {path.string()});
  } catch (...) {
    fs::remove_all(temporary, ignored);
    throw;
  }
}

}  // namespace

std::shared_ptr<const ClipShape> clip_shape(const RobotModel& model, const SimulationLog& log,
                                            const ClipOptions& options, bool thin_surface,
                                            const Progress& progress) {
  check(model, log, options);
  auto shape = std::make_shared<ClipShape>();
  const std::shared_ptr<const RobotLook> look =
      options.look ? options.look : robot_look(model, progress);
  std::vector<BodySurface> surface = look->surface;
  shape->height = robot_height(surface, model, log);
  double moved = look->moved;
  if (thin_surface) {
    // Size of a pixel [m] if the robot just fits into the picture.
    const double pixel =
        shape->height / (options.picture.height * std::max(1.0, options.camera.zoom));
    if (moved <= 0) leave_out_hidden(surface);
    const double thinned = thin_to(surface, kThinned * pixel, kMostOfClip, progress);
    if (thinned > kThinned * pixel) moved = std::max(moved, thinned);
  }
  const size_t most =
      thin_surface ? std::min(kMostOfClip, options.max_triangles) : options.max_triangles;
  moved = std::max(moved, std::sqrt(3.0) * simplify(surface, most));
  shape->notes = notes_of(model, *look, triangle_count(surface), moved);
  shape->outline = outlines(surface);
  shape->robot = drawn_robot(surface);
  shape->ghost = options.overlay.heat ? look->ghost.beside_heat : look->ghost.beside_robot;
  return shape;
}

ClipRenderer::ClipRenderer(const RobotModel& model, const SimulationLog& log,
                           const ClipOptions& options)
    : ClipRenderer(model, log, options, clip_shape(model, log, options, false)) {}

ClipRenderer::ClipRenderer(const RobotModel& model, const SimulationLog& log,
                           const ClipOptions& options, std::shared_ptr<const ClipShape> shape)
    : model_(model),
      log_(log),
      options_((check(model, log, options), options)),
      pushes_(pushes(log)),
      notes_(shape->notes),
      height_(shape->height),
      outline_(shape->outline),
      verdict_at_(verdict_instant(log)),
      ghost_(shape->ghost),
      bumps_(rising_bumps(model, log)),
      renderer_(options.picture, *shape->robot, scenery_of(log)),
      path_(make_path(log, options, height_)) {
  notes_.insert(notes_.end(), renderer_.notes().begin(), renderer_.notes().end());
}

void ClipRenderer::add_ghost(double t, Scene& scene) const {
  // Tint of a ghost. Chosen: a seventh of the robot's own colours stays, which shows its parts.
  const Eigen::Vector4f tint = {ghost_[0], ghost_[1], ghost_[2], 0.85f};
  if (options_.ghost.log)
    scene.exposures.push_back({body_poses(model_, sample_at(*options_.ghost.log, t).state), tint});
  if (!options_.ghost.command) return;
  const SimulationSample sample = sample_at(log_, t);
  RobotState state = sample.state;
  state.base = sample.command_base;
  state.theta = sample.command_theta;
  scene.exposures.push_back({body_poses(model_, state), tint});
}

Scene ClipRenderer::scene_at(double t, Overlay& overlay) const {
  const SimulationSample sample = sample_at(log_, t);
  Scene scene;
  scene.poses = body_poses(model_, sample.state);
  scene.camera = framing_ ? framed(path_.at(t), *framing_) : path_.at(t);
  scene.ground = ground_at(log_, t);
  scene.floor = floor_at(log_, t);
  scene.bumps = make_bumps(bumps_, log_.world.height, t);
  if (options_.overlay.heat) scene.heat = joint_heat(model_, log_.provenance.profile, sample);
  add_ghost(t, scene);
  overlay = make_overlay(model_, log_, pushes_, t, sample, scene.poses, height_, options_.overlay);
  scene.overlay = std::move(overlay.triangles);
  return scene;
}

Image ClipRenderer::frame(double t) {
  shown_ = {{t, t}};
  return drawn(t);
}

Image ClipRenderer::clip_frame(double t) {
  shown_ = {{options_.begin, options_.end < 0 ? duration(log_) : options_.end}};
  return drawn(t);
}

Image ClipRenderer::drawn(double t) {
  Overlay overlay;
  const Scene scene = scene_at(t, overlay);
  Image image = finished(scene, overlay, t);
  if (options_.overlay.caption) write_caption(image, t);
  return image;
}

Image ClipRenderer::tile(double t) {
  Overlay overlay;
  const Scene scene = scene_at(t, overlay);
  overlay.labels.clear();  // the corner of the picture shows it
  Image image = finished(scene, overlay, t);
  if (!options_.overlay.caption) return image;
  const double size = std::clamp(image.height / 30.0, 9.0, 54.0);
  const std::string event = instant_text(log_, t);
  draw_text(image, 0.4 * size, 1.1 * size,
            text::fixed(t, 2) + " s" + (event.empty() ? "" : "  " + event),
            {.size = size, .bold = !event.empty(), .plate = {1, 1, 1, 0.72f}});
  return image;
}

void ClipRenderer::frame_robot(const std::vector<double>& times) {
  // Share of a picture's height that the robot takes. The rest is room for the line of text.
  constexpr double kShare = 0.88;
  framing_.reset();
  shown_.clear();
  for (const double t : times) shown_.emplace_back(t, t);
  std::vector<Vector3d> offsets;
  Camera camera;
  for (const double t : times) {
    camera = path_.at(t);
    const Eigen::Matrix3d axes = view_matrix(camera).topLeftCorner<3, 3>();
    const std::vector<Eigen::Isometry3d> poses = body_poses(model_, sample_at(log_, t).state);
    for (size_t i = 0; i < poses.size(); ++i)
      for (const Vector3d& point : outline_[i])
        offsets.emplace_back(axes * (poses[i] * point - camera.target));
  }
  const double aspect = double(options_.picture.width) / options_.picture.height;
  Framing found = framing(camera, aspect, offsets, kShare);
  found.distance /= options_.camera.zoom;
  framing_ = found;
}

namespace {

/// A text such as "t = 0.00, 1.20, 2.40 s". If there are many instants, the first and the last are
/// named; for a single one, the text is empty.
std::string instants_text(const std::vector<double>& times) {
  // Number of instants that are named. Chosen: as many as fit beside a title.
  constexpr size_t kNamed = 6;
  if (times.size() < 2) return "";
  std::vector<std::string> each;
  for (const double t : times) each.push_back(text::fixed(t, 2));
  if (each.size() > kNamed)
    return "t = " + each.front() + " to " + each.back() + " s, " + std::to_string(each.size()) +
           " postures";
  return "t = " + text::join(each, ", ") + " s";
}

}  // namespace

Image ClipRenderer::exposures(const std::vector<double>& times) {
  if (times.empty()) fail(ErrorCode::usage, "a picture needs at least one time");
  shown_ = {{times.back(), times.back()}};
  Overlay overlay;
  Scene scene = scene_at(times.back(), overlay);
  scene.exposures.clear();
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    const double share = double(i + 1) / double(times.size());
    scene.exposures.push_back({body_poses(model_, sample_at(log_, times[i]).state),
                               Eigen::Vector4f::Zero(), 0.25 + 0.5 * share});
  }
  Image image = finished(scene, overlay, times.back());
  if (options_.overlay.caption) write_caption(image, times.back(), instants_text(times));
  return image;
}

Image ClipRenderer::finished(const Scene& scene, const Overlay& overlay, double t) {
  Image image = renderer_.render(scene);
  const double size = std::clamp(image.height / 32.0, 9.0, 60.0);
  for (const Label& label : overlay.labels) {
    const Vector3d at = project(scene.camera, image.width, image.height, label.position);
    const auto opacity = static_cast<float>(label.opacity);
    const TextStyle style = {.size = size,
                             .bold = true,
                             .anchor = TextAnchor::center,
                             .color = {0.45f, 0.08f, 0.33f, opacity},
                             .plate = {1, 1, 1, 0.75f * opacity}};
    // The label stays in the room between the lines of text above and below.
    const double y = std::clamp(at.y(), std::min(2.6 * size, 0.5 * image.height),
                                std::max(image.height - 2.6 * size, 0.5 * image.height));
    const double half = 0.5 * drawn_width(label.text, style), most = image.width - half;
    const double x = std::clamp(at.x(), std::min(half, most), std::max(half, most));
    if (at.z() > 0) draw_text(image, x, y, label.text, style);
  }
  if (options_.overlay.scale && scene.camera.parallel_height > 0)
    write_scale(image, scene.camera, t);
  return image;
}

namespace {

// Writes a title in at most `room` pixels: in smaller letters, and shortened if this is not enough.
// Returns the width that it takes.
double write_within(Image& image, double x, double y, std::string title, TextStyle style,
                    double room) {
  constexpr double kSmallest =
      0.7;  // smallest share of the size. Chosen: the smallest letters that can be read well
  if (title.empty()) return 0;
  const double wide = drawn_width(title, style);
  if (wide > room) style.size *= std::clamp(room / wide, kSmallest, 1.0);
  const auto fits = [&](const std::string& text) { return drawn_width(text, style) <= room; };
  return draw_text(image, x, y, text::shortened(title, fits), style);
}

}  // namespace

double ClipRenderer::write_title(Image& image, double top, double size, double t,
                                 const std::string& instants) const {
  const double margin = 0.6 * size, y = top + margin + 0.7 * size;
  const TextStyle plain = {.size = size, .plate = {1, 1, 1, 0.72f}};
  TextStyle bold = plain;
  bold.bold = true;
  const std::string title =
      options_.title.empty() ? plain_name(log_.provenance.pattern) : options_.title;
  // The room is the same at every time, so that the title does not change its size in a clip.
  double room = image.width - 2 * margin;
  if (log_.controller)
    room -= drawn_width(law_name(*log_.controller), plain) +
            drawn_width(verdict_text(log_.result), bold);
  const auto when = [&](double at) {
    return instants.empty() ? "t = " + text::fixed(at, 3) + " s" : instants;
  };
  if (!framing_) room -= drawn_width(when(duration(log_)), plain);
  double x = margin;
  x += write_within(image, x, y, title, bold, room);
  if (log_.controller) x += draw_text(image, x, y, law_name(*log_.controller), plain);
  if (!framing_) draw_text(image, x, y, when(t), plain);
  if (log_.controller && t >= verdict_at_ - 1e-9) {  // a plan has no outcome
    TextStyle verdict = bold;
    verdict.anchor = TextAnchor::right;
    verdict.color = log_.result.outcome == Outcome::stands
                        ? Eigen::Vector4f(0.02f, 0.40f, 0.25f, 1)
                        : Eigen::Vector4f(0.70f, 0.08f, 0.08f, 1);
    draw_text(image, image.width - margin, y, verdict_text(log_.result), verdict);
  }
  return 2 * margin + 1.4 * size;
}

double ClipRenderer::write_legend(Image* image, int width, double top, double size) const {
  struct Entry {
    bool shown;
    std::string text;
    Eigen::Vector4f color;
  };
  using namespace overlay_color;
  const OverlayOptions& on = options_.overlay;
  const bool ghost = options_.ghost.command || options_.ghost.log;
  const bool pushed = std::any_of(shown_.begin(), shown_.end(), [&](const auto& span) {
    return shows_push(pushes_, span.first, span.second, on);
  });
  const std::array<Entry, 9> entries = {
      {{on.cog, "● COG", kCog},
       {on.zmp, "● ZMP", kZmp},
       {on.reference_zmp, "○ ref ZMP", kReferenceZmp},
       {on.support, "▭ support", kSupport},
       {on.forces, "↑ foot force", kForce},
       {on.push && pushed, "→ push", kPush},
       {on.heat, "■ joint near a limit of angle, speed or torque", heat_color(0)},
       {on.heat, "■ joint at its limit", heat_color(1)},
       {ghost,
        "▒ " + (options_.ghost.command ? "command" : options_.ghost.name),
        {ghost_[0], ghost_[1], ghost_[2], 1}}}};
  const double margin = 0.6 * size, line = 1.7 * size;
  double x = margin, y = top + 0.5 * line;
  for (const Entry& entry : entries) {
    if (!entry.shown) continue;
    TextStyle style = {.size = size, .plate = {1, 1, 1, 0.72f}};
    style.color = entry.color;
    style.color.head<3>() *= 0.75f;  // dark enough to be readable on the plate
    style.color[3] = 1;
    const int wide = drawn_width(entry.text, style);
    if (x > margin && x + wide > width - margin) {
      x = margin;
      y += line;
    }
    if (image) draw_text(*image, x, y, entry.text, style);
    x += wide;
  }
  return x > margin ? y + 0.5 * line - top : 0;
}

void ClipRenderer::write_caption(Image& image, double t, const std::string& instants) const {
  const double size = std::clamp(image.height / 36.0, 9.0, 54.0);
  write_title(image, 0, size, t, instants);
  const double tall = write_legend(nullptr, image.width, 0, 0.8 * size);
  write_legend(&image, image.width, image.height - tall - 0.5 * size, 0.8 * size);
}

void ClipRenderer::write_scale(Image& image, const Camera& camera, double t) const {
  const double size = std::clamp(image.height / 40.0, 9.0, 40.0);
  const Eigen::Isometry3d ground = ground_at(log_, t);
  const Vector3d n = ground.linear().col(2);
  // The ground below the middle of the picture, in the direction of gravity.
  Vector3d below = camera.target;
  below.z() -= n.dot(camera.target - ground.translation()) / n.z();
  const double pixel = camera.parallel_height / image.height;  // height of a pixel [m]
  const double foot = project(camera, image.width, image.height, below).y();
  // Distance between marks, the smallest of 1, 2, 5 times a power of ten with at least three lines
  // of text between marks [m].
  double step = 1;
  for (const double next : {0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005, 0.002, 0.001})
    if (next / pixel >= 3 * size) step = next;
  const auto line = [&](double y, int from, int to, double share) {
    const int row = static_cast<int>(std::lround(y));
    if (row < 0 || row >= image.height) return;
    for (int x = std::max(0, from); x < std::min(image.width, to); ++x)
      for (int c = 0; c < 3; ++c) {
        std::uint8_t& value = image.pixel(x, row)[c];
        value = static_cast<std::uint8_t>(std::lround(value * (1 - share)));
      }
  };
  // Margin to the sides, and a top below the title.
  const double margin = 0.6 * size, top = margin + 2.4 * size;
  const bool millimetres = step < 0.01;
  for (int k = 0; foot - k * step / pixel > top; ++k) {
    const double y = foot - k * step / pixel;
    line(y, 0, image.width, k == 0 ? 0.45 : 0.12);
    line(y, 0, static_cast<int>(margin), 0.8);
    const std::string number =
        millimetres ? text::fixed(1e3 * k * step, 0) + " mm" : text::fixed(k * step, 2) + " m";
    if (y < image.height - 2 * size) draw_text(image, margin, y, number, {.size = size});
  }
}

ClipSummary write_clip(const RobotModel& model, const SimulationLog& log, const fs::path& path,
                       const ClipOptions& options, const Progress& progress) {
  check(model, log, options);
  const RenderOptions& picture = options.picture;
  if (path.extension() == ".png") {
    ClipRenderer renderer(model, log, options);
    const double at = options.at ? *options.at : telling_instant(log);
    write_png(path, renderer.frame(at));
    return {1, picture.width, picture.height, options.fps, at, renderer.notes()};
  }
  const int count = static_cast<int>(frames_of(log, options));
  const auto time = [&](int k) { return options.begin + k * options.speed / options.fps; };
  std::once_flag shaped;
  std::shared_ptr<const ClipShape> shape;  // made by the first thread that needs it
  std::exception_ptr unshaped;
  std::atomic<bool> stopped = false;
  const auto make = [&] {
    std::call_once(shaped, [&] {  // after an exception here, the next thread would try again
      try {
        shape = clip_shape(model, log, options, count >= kThinFrames,
                           [&](const ProgressEvent&) { return !stopped; });
      } catch (...) {
        unshaped = std::current_exception();
      }
    });
    if (unshaped) std::rethrow_exception(unshaped);
    return std::make_unique<ClipRenderer>(model, log, options, shape);
  };
  std::vector<std::string> notes;
  const auto frames = [&](const std::function<void(int, const Image&)>& use) {
    FrameQueue queue(options.threads, count, make, time);
    for (int k = 0; k < count; ++k) {
      const auto alive = [&] {
        try {
          report(progress,
                 {"drawing the preview", double(k) / count, "frame " + std::to_string(k)});
        } catch (...) {
          stopped = true;  // stops the threads that prepare the surface
          throw;
        }
      };
      alive();
      Image image = queue.take(k, alive);
      use(k, image);
      queue.give_back(k, std::move(image));
      if (k == 0) notes = queue.notes();
    }
  };
  if (path.extension().empty()) {
    write_folder(path, options.overwrite, [&](const fs::path& folder) {
      frames([&](int k, const Image& image) { write_png(folder / frame_name(k), image); });
    });
  } else {
    write_file_with(path, [&](const fs::path& temporary) {
      try {
        double done = 0;
        const auto alive = [&] { report(progress, {"drawing the preview", done, ""}); };
        ClipEncoder encoder(temporary, picture.width, picture.height, options.fps, options.encoder,
                            alive);
        frames([&](int k, const Image& image) {
          done = double(k) / count;
          encoder.add(image);
        });
        encoder.finish();
      } catch (const Error& error) {
        throw Error(error.code(), with_name(error.what(), temporary.string(), path.string()),
                    {path.string()});
      }
    });
  }
  report(progress, {"drawing the preview", 1.0, std::to_string(count) + " frames"});
  return {count, picture.width, picture.height, options.fps, {}, notes};
}

}  // namespace ayumi
