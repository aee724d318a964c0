#include "author/author_session.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <system_error>

#include "author/author_pose.hpp"
#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/io/json/json_text.hpp"
#include "ayumi/io/pattern/pattern_edit.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/pattern/pattern_table.hpp"
#include "ayumi/io/run/sha256.hpp"
#include "ayumi/plan/viip_phases.hpp"
#include "ayumi/report/replay.hpp"

namespace ayumi::app {

namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

// Time between two messages about the progress of a job. Chosen: a bar that moves ten times a
// second looks smooth.
constexpr auto kNews = 100ms;
// Number of events that are kept for slow pages. A page that misses some asks for the whole state.
constexpr size_t kKeptEvents = 256;
// Largest number of triangles of the robot in the page, as in reports.
constexpr size_t kTriangles = 60'000;

AuthorAnswer refused(const std::string& message) { return {422, {{"message", message}}}; }

// Calls `work`. If it throws, the answer contains the message.
template <typename Work>
AuthorAnswer answered(const fs::path& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    return refused(without_file(error, file));
  } catch (const nlohmann::json::exception&) {
    return {400, {{"message", "the request does not have the form that the page sends"}}};
  }
}

}  // namespace

struct AuthorSession::View {
  std::uint64_t version = 0;
  std::string text, hash;
  std::optional<OrderedJson> error;  // reason why the text has no motion
  // Structure of a pattern that can be read but has no motion.
  std::optional<OrderedJson> structure;
  std::shared_ptr<const AuthorMotion> motion;  // motion of the text, or the last motion before
  std::shared_ptr<const AuthorMotion> ghost;   // the last consistent motion, if it is another one
  std::optional<AuthorResult> result;          // result of the last job on this text
  int undo_steps = 0, redo_steps = 0;
};

AuthorSession::AuthorSession(const Context& context, AuthorSetting setting)
    : context_(context), setting_(std::move(setting)) {
  refresh();
  follower_ = std::thread([this] { follow(); });
}

AuthorSession::~AuthorSession() {
  stop();
  if (worker_.joinable()) worker_.join();
  follower_.join();
}

void AuthorSession::stop() {
  {
    const std::lock_guard lock(state_);  // a waiting thread has seen the change or will be notified
    stopping_ = true;
  }
  changed_.notify_all();
}

AuthorSession::Shown AuthorSession::view() {
  const std::lock_guard lock(state_);
  return shown_;
}

void AuthorSession::publish(std::shared_ptr<View> view) {
  std::uint64_t version = 0;
  {
    const std::lock_guard lock(state_);
    version = view->version = shown_ ? shown_->version + 1 : 1;
    shown_ = std::move(view);
  }
  tell("state", {{"version", version}});
}

void AuthorSession::tell(const std::string& name, const OrderedJson& data) {
  {
    const std::lock_guard lock(state_);
    events_.push_back({name, data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)});
    if (events_.size() > kKeptEvents) {
      events_.pop_front();
      ++first_event_;
    }
  }
  changed_.notify_all();
}

std::uint64_t AuthorSession::next_event() {
  const std::lock_guard lock(state_);
  return first_event_ + events_.size();
}

std::optional<AuthorEvent> AuthorSession::wait_for_event(std::uint64_t number) {
  std::unique_lock lock(state_);
  changed_.wait_for(lock, 200ms,
                    [&] { return stopping_ || number < first_event_ + events_.size(); });
  if (number >= first_event_ + events_.size()) return {};
  return events_[number < first_event_ ? 0 : static_cast<size_t>(number - first_event_)];
}

// ---- following of the files

AuthorSession::Stamps AuthorSession::stamps() const {
  std::vector<fs::path> files = {setting_.file};
  try {
    files = pattern_files(setting_.file);
  } catch (const Error&) {  // the files that were named before are still watched
    for (const auto& [file, stamp] : seen_) files.push_back(file);
  }
  for (const fs::path& file : robot_files()) files.push_back(file);
  Stamps stamps;
  for (const fs::path& file : files) stamps[file] = stamp_of(file);
  return stamps;
}

void AuthorSession::follow() {
  while (true) {
    {
      std::unique_lock lock(state_);
      if (changed_.wait_for(lock, kFileLook, [&] { return stopping_.load(); })) return;
    }
    const std::lock_guard lock(reading_);
    if (is_gone()) continue;
    const bool same = std::all_of(seen_.begin(), seen_.end(), [](const auto& seen) {
      return stamp_of(seen.first) == seen.second;
    });
    try {
      const bool look_again =
          read_at_ && std::chrono::steady_clock::now() - *read_at_ > kFileClockStep;
      if (look_again) read_at_.reset();
      if (same && !(look_again && read_file(setting_.file) != view()->text)) continue;
      await_written(setting_.file);
      refresh();
    } catch (const Error&) {  // the file is missing for a moment; the next check finds it
    }
  }
}

// Whether the file is missing. A file that stays missing is an error of the page until it comes
// back.
bool AuthorSession::is_gone() {
  const auto now = std::chrono::steady_clock::now();
  if (stamp_of(setting_.file).size >= 0) {
    gone_since_.reset();
    return false;
  }
  seen_[setting_.file] = {};  // any file that comes back is read
  if (!gone_since_) gone_since_ = now;
  const Shown before = view();
  const std::string words =
      "the file no longer exists. The page continues as soon as the file exists again";
  if (now - *gone_since_ < kFileGone || (before->error && (*before->error)["message"] == words))
    return true;
  auto next = std::make_shared<View>(*before);
  next->error = OrderedJson::object({{"message", words}});
  next->structure.reset();
  publish(std::move(next));
  return true;
}

void AuthorSession::load_robot_of(const std::string& text, bool anew) {
  const Pattern pattern = pattern_of_text(text, setting_.file, setting_.set);
  const std::string name = robot_of(pattern);
  if (robot_ && name == robot_->named.name && !anew) return;
  RobotModel model = load_robot(name, robot_search(context_), {.meshes = true});
  std::vector<BodySurface> surface = robot_surface(model);
  robot_ = ShownRobot{{std::move(model), name}, std::move(surface)};
  for (const fs::path& file : robot_files()) seen_[file] = stamp_of(file);
  const std::lock_guard lock(state_);
  model_.clear();
}

std::vector<fs::path> AuthorSession::robot_files() const {
  std::vector<fs::path> files;
  if (robot_)
    for (const std::string& file : {robot_->named.model.description().urdf_file,
                                    robot_->named.model.description().sidecar_file})
      if (!file.empty()) files.emplace_back(file);
  return files;
}

bool AuthorSession::robot_changed() const {
  const std::vector<fs::path> files = robot_files();
  return std::any_of(files.begin(), files.end(), [&](const fs::path& file) {
    const auto seen = seen_.find(file);
    return seen != seen_.end() && stamp_of(file) != seen->second;
  });
}

// The caller must hold `reading_`, except at the first call. The modification times are read before
// the contents, so that a save in between is noticed at the next check.
void AuthorSession::refresh() {
  const bool new_robot = robot_ && robot_changed();
  seen_ = stamps();
  read_at_ = std::chrono::steady_clock::now();
  const std::string text = read_file(setting_.file);
  const Shown before = view();
  auto next = std::make_shared<View>();
  next->text = text;
  next->hash = sha256(text);
  history_.add(text);
  next->undo_steps = history_.undo_steps();
  next->redo_steps = history_.redo_steps();
  if (before) {
    next->motion = before->motion;
    next->ghost = before->ghost;
  }
  try {
    load_robot_of(text, new_robot);
    auto motion = author_motion(text, *robot_, setting_);
    if (next->motion && next->motion->judgement.good()) next->ghost = next->motion;
    next->motion = std::move(motion);
  } catch (const Error& error) {
    const SourcePlace& at = error.place();
    const std::string pointer = at.inside.starts_with("/") ? at.inside : "";
    const bool here = at.file == setting_.file.string();
    next->error = {{"message", without_file(error, setting_.file)}, {"pointer", pointer}};
    if (here && at.line > 0) (*next->error)["line"] = at.line;
    // An error of the whole file, or of a part that is missing in it, has no line. A text that is
    // not JSON has no pointer.
    if (here && at.line == 0 && !pointer.empty()) {
      const size_t value = nearest_value(text, pointer).begin;
      if (value != nearest_value(text, "").begin) (*next->error)["line"] = line_at(text, value);
    }
  }
  if (next->error) {
    try {
      next->structure = author_structure(pattern_of_text(text, setting_.file, setting_.set),
                                         OrderedJson::parse(text, nullptr, true, true));
    } catch (const Error&) {  // the page shows the places of the old motion and changes nothing
    } catch (const nlohmann::json::exception&) {
    }
  }
  publish(std::move(next));
}

// ---- data for the page

std::string AuthorSession::state() {
  const Shown shown = view();
  OrderedJson json = {{"version", shown->version},
                      {"file", setting_.file.filename().string()},
                      {"text", shown->text},
                      {"hash", shown->hash},
                      {"error", shown->error ? *shown->error : OrderedJson(nullptr)},
                      {"stale", shown->error.has_value()},
                      {"undo", shown->undo_steps},
                      {"redo", shown->redo_steps}};
  OrderedJson features = {"undo"};
  // If a text cannot be read, the page only knows the places of the old motion, and a change would
  // affect another keyframe than the one that is shown.
  if (!shown->error || shown->structure) features.push_back("edit");
  if (shown->motion) {
    json.update(shown->motion->parts);
    // If the motion is older than the text, only the text can be changed.
    if (!shown->error) {
      for (const char* const each : {"pose.joints", "pose.drag", "posture", "mirror"})
        features.push_back(each);
      for (const std::string& kind : author_job_kinds()) features.push_back("job." + kind);
    }
    OrderedJson motions = {"plan"}, strips = shown->motion->parts["strips"];
    if (shown->ghost) {
      motions.push_back("ghost");
      strips["ghost"] = shown->ghost->parts["strips"]["plan"];
    }
    if (shown->result) {
      for (const auto& [which, series] : shown->result->series) motions.push_back(which);
      strips.update(shown->result->strips);
    }
    json["motions"] = motions;
    json["strips"] = strips;
    json["result"] = shown->result ? shown->result->shown : OrderedJson(nullptr);
  }
  if (shown->structure) json.update(*shown->structure);
  json["features"] = features;
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<std::string> AuthorSession::series(const std::string& which) {
  const Shown shown = view();
  if (which == "plan" && shown->motion) return shown->motion->series;
  if (which == "ghost" && shown->ghost) return shown->ghost->series;
  if (!shown->result) return {};
  const auto found = shown->result->series.find(which);
  return found == shown->result->series.end() ? std::nullopt : std::optional(found->second);
}

std::string AuthorSession::model() {
  const Shown shown = view();
  if (!shown->motion) return {};
  const std::lock_guard lock(state_);
  if (model_.empty())
    model_ = live_model(shown->motion->task.robot, shown->motion->plan, kTriangles);
  return model_;
}

std::string AuthorSession::scenery() {
  const Shown shown = view();
  return shown->motion ? live_scenery(shown->motion->task.pattern.world) : std::string();
}

// ---- edits

AuthorAnswer AuthorSession::conflict(const View& shown, const std::string& mine) {
  return {409, {{"theirs", shown.text}, {"theirs_hash", shown.hash}, {"mine", mine}}};
}

// `reading_` must be locked by the caller. `seen` is the text that the page has seen.
AuthorAnswer AuthorSession::write(const std::string& seen, const std::string& text) {
  if (!replace_text(setting_.file, seen, text)) {
    refresh();
    return conflict(*view(), text);
  }
  refresh();
  return {200, {{"version", view()->version}}};
}

namespace {

// Throws the error of a text that cannot be read as a pattern. If the text can be read, but the
// robot cannot do the motion, nothing is thrown: the page shows this error at its line.
void require_readable(const std::string& text, const AuthorSetting& setting) {
  const Pattern pattern = pattern_of_text(text, setting.file, setting.set);
  if (has_viip_phases(pattern)) without_viip_phases(pattern);
}

// Refuses a change that makes a pattern unreadable. A pattern that was unreadable before may stay
// so.
void refuse_unreadable(const std::string& before, const std::string& after,
                       const AuthorSetting& setting) {
  try {
    require_readable(after, setting);
  } catch (const Error& error) {
    try {
      require_readable(before, setting);
    } catch (const Error&) {
      return;
    }
    fail(error.code(), "nothing was written, because the pattern could not be read then: " +
                           without_file(error, setting.file));
  }
}

}  // namespace

AuthorAnswer AuthorSession::edit(const OrderedJson& request) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const std::lock_guard lock(reading_);
    const std::string seen_hash = request.at("hash");
    std::vector<PatternEdit> edits;
    if (!request.contains("text"))
      for (const auto& one : request.at("edits")) {
        const std::string kind = one.at("kind");
        if (kind != "set" && kind != "insert" && kind != "remove" && kind != "repeat")
          return refused("there is no edit '" + kind + "'");
        edits.push_back({kind == "set"      ? PatternEdit::Kind::set
                         : kind == "insert" ? PatternEdit::Kind::insert
                         : kind == "repeat" ? PatternEdit::Kind::repeat
                                            : PatternEdit::Kind::remove,
                         one.at("pointer"), one.contains("value") ? one["value"].dump() : ""});
      }
    // The text that the page has seen is the present one or an earlier one.
    std::string base = view()->text;
    if (read_file(setting_.file) != base) refresh();
    const Shown shown = view();
    if (seen_hash != shown->hash) {
      for (int i = 0; i <= history_.undo_steps(); ++i)
        if (sha256(history_.near(-i)) == seen_hash) base = history_.near(-i);
      return conflict(*shown, request.contains("text") ? request["text"].get<std::string>()
                                                       : edited_text(base, edits, setting_.set));
    }
    const std::string text = request.contains("text")
                                 ? request["text"].get<std::string>()
                                 : edited_text(shown->text, edits, setting_.set);
    refuse_unreadable(shown->text, text, setting_);
    return write(shown->text, text);
  });
}

AuthorAnswer AuthorSession::step(const OrderedJson& request, int by) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const std::lock_guard lock(reading_);
    if (read_file(setting_.file) != view()->text) refresh();
    const Shown shown = view();
    const bool possible = by < 0 ? history_.undo_steps() > 0 : history_.redo_steps() > 0;
    if (request.at("hash") != shown->hash || !possible)
      return refused(
          possible ? "the file has changed in the meantime. Look at the new text, then try again"
          : by < 0 ? "there is nothing to undo"
                   : "there is nothing to redo");
    const std::string text = history_.near(by);
    if (!replace_text(setting_.file, shown->text, text)) {
      refresh();
      return refused("the file has changed in the meantime. Look at the new text, then try again");
    }
    history_.step(by);
    refresh();
    return {200, {{"version", view()->version}}};
  });
}

namespace {

// The edits in the form in which the page sends them back.
OrderedJson edits_json(const std::vector<PatternEdit>& edits) {
  OrderedJson list = OrderedJson::array();
  for (const PatternEdit& edit : edits) {
    const bool removes = edit.kind == PatternEdit::Kind::remove;
    list.push_back({{"kind", removes                               ? "remove"
                             : edit.kind == PatternEdit::Kind::set ? "set"
                                                                   : "insert"},
                    {"pointer", edit.pointer}});
    if (!removes) list.back()["value"] = OrderedJson::parse(edit.value);
  }
  return list;
}

}  // namespace

AuthorAnswer AuthorSession::pose(const OrderedJson& request) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const Shown shown = view();
    if (!shown->motion || shown->error)
      return refused("the text of the pattern has an error. Correct it first");
    PoseWish wish;
    wish.time = request.at("time");
    if (request.contains("joints"))
      wish.joints = request["joints"].get<std::map<std::string, double>>();
    if (request.contains("drag")) wish.drag = request["drag"];
    if (request.contains("target")) wish.target = request["target"];
    const auto place = [&](const char* name) {
      const auto xyz = request.at(name).get<std::array<double, 3>>();
      return Eigen::Vector3d(xyz[0], xyz[1], xyz[2]);
    };
    if (request.contains("to")) wish.to = place("to");
    if (request.contains("from")) wish.from = place("from");
    const PoseAnswer answer = posed(*shown->motion, shown->text, setting_, wish);
    OrderedJson row = nullptr;
    if (!answer.row.empty()) {
      row = OrderedJson::array();
      for (size_t i = 0; i + sizeof(float) <= answer.row.size(); i += sizeof(float)) {
        float value = 0;
        std::memcpy(&value, answer.row.data() + i, sizeof value);
        row.push_back(value);
      }
    }
    return {
        200,
        {{"row", row},
         {"edits", edits_json(answer.edits)},
         {"message", answer.message.empty() ? OrderedJson(nullptr) : OrderedJson(answer.message)}}};
  });
}

AuthorAnswer AuthorSession::posture(const OrderedJson& request) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const Shown shown = view();
    if (!shown->motion || shown->error)
      return refused("the text of the pattern has an error. Correct it first");
    return {200,
            {{"edits",
              edits_json(captured(*shown->motion, request.at("time"), request.at("name"),
                                  request.value("mirror", false),
                                  request.value("joints", std::map<std::string, double>())))}}};
  });
}

AuthorAnswer AuthorSession::mirror(const OrderedJson& request) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const Shown shown = view();
    if (!shown->motion || shown->error)
      return refused("the text of the pattern has an error. Correct it first");
    const MirroredKeyframe mirrored =
        mirrored_keyframe(*shown->motion, shown->text, setting_, request.at("pointer"));
    OrderedJson answer = {{"edits", edits_json(mirrored.edits)}};
    if (mirrored.text) answer["text"] = *mirrored.text;
    // The text belongs to this version of the file. A change in the meantime must not be lost.
    answer["hash"] = shown->hash;
    return {200, answer};
  });
}

// ---- jobs

AuthorAnswer AuthorSession::start_job(const OrderedJson& request) {
  return answered(setting_.file, [&]() -> AuthorAnswer {
    const std::lock_guard lock(jobs_);
    const std::string kind = request.at("kind");
    const auto& kinds = author_job_kinds();
    if (std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
      return refused("there is no job '" + kind + "'");
    const Shown shown = view();
    if (!shown->motion || shown->error)
      return refused("the text of the pattern has an error. Correct it first");
    if (job_runs_) return refused("another job is running. Wait for it or cancel it");
    if (worker_.joinable()) worker_.join();
    job_stops_ = false;
    const std::uint64_t id = ++job_;
    job_runs_ = true;
    try {
      worker_ =
          std::thread([this, id, kind, options = request.value("options", OrderedJson::object()),
                       shown] { work(id, kind, options, shown); });
    } catch (const std::system_error&) {  // too many threads run on this machine
      job_runs_ = false;
      return refused("the job could not be started. Close other programs and try again");
    }
    return {200, {{"id", std::to_string(id)}}};
  });
}

void AuthorSession::work(std::uint64_t id, std::string kind, OrderedJson options, Shown shown) {
  OrderedJson news = {{"id", std::to_string(id)},
                      {"kind", kind},
                      {"progress", nullptr},
                      {"text", ""},
                      {"done", false},
                      {"error", nullptr}};
  tell("job", news);
  auto last = std::chrono::steady_clock::now();
  std::mutex telling;
  const Progress progress = [&](const ProgressEvent& event) {
    const std::lock_guard lock(telling);
    const auto now = std::chrono::steady_clock::now();
    if (now - last >= kNews) {
      last = now;
      news["progress"] = event.fraction < 0 ? OrderedJson(nullptr) : OrderedJson(event.fraction);
      news["text"] = event.detail.empty() ? event.stage : event.stage + ", " + event.detail;
      tell("job", news);
    }
    return !job_stops_ && !stopping_;
  };
  std::optional<AuthorResult> result;
  try {
    result = author_job(kind, options, context_, *shown->motion, shown->text, setting_, progress);
  } catch (const Interrupted&) {
    news["error"] = "cancelled";
  } catch (const Error& error) {
    news["error"] = without_file(error, setting_.file);
  } catch (const std::exception& error) {
    news["error"] = error.what();
  }
  // From here on, another job may start, because a page that sees the result below may start one at
  // once. start_job() joins this thread first.
  job_runs_ = false;
  if (result) {
    // If the text has changed, the result would be shown beside another motion, so it is dropped.
    const std::lock_guard lock(reading_);
    const Shown now = view();
    if (now->hash == shown->hash && !now->error) {
      auto next = std::make_shared<View>(*now);
      next->result = std::move(result);
      publish(std::move(next));
    } else {
      news["error"] =
          "the pattern has changed in the meantime. This answer belongs to the old pattern";
    }
  }
  news["progress"] = 1;
  news["text"] = "";
  news["done"] = true;
  tell("job", news);
}

AuthorAnswer AuthorSession::cancel_job(const std::string& id) {
  const std::lock_guard lock(jobs_);
  if (!job_runs_ || id != std::to_string(job_))
    return {404, {{"message", "this job has already ended"}}};
  job_stops_ = true;
  return {};
}

}  // namespace ayumi::app
