#pragma once
// The pattern while it is being authored. The session follows the file, keeps the last motion that
// could be read and the last consistent one, writes edits into the author's text, and runs jobs.
// All functions may be called by several threads at once. Answers are JSON as docs/author.md
// describes them.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "author/author_file.hpp"
#include "author/author_jobs.hpp"
#include "author/author_motion.hpp"
#include "file_stamp.hpp"

namespace ayumi::app {

struct AuthorAnswer {
  int status = 200;
  OrderedJson body = OrderedJson::object();
};

struct AuthorEvent {
  std::string name;  ///< name, such as "state" or "job"
  std::string data;  ///< data as JSON
};

class AuthorSession {
 public:
  /// Throws the same errors as read_file(). A pattern that cannot be read is shown with its error,
  /// but its robot must have been loaded once. `context` must outlive the session.
  AuthorSession(const Context& context, AuthorSetting setting);
  /// Stops, and waits for the job and the thread that follows the file.
  ~AuthorSession();
  AuthorSession(const AuthorSession&) = delete;
  AuthorSession& operator=(const AuthorSession&) = delete;

  /// Ends the job and the following of the file soon after the call.
  void stop();

  /// The state that the page shows, as JSON.
  std::string state();
  /// The table "plan", "ghost", "repair", "open_loop" or "closed_loop".
  std::optional<std::string> series(const std::string& which);
  std::string model();
  std::string scenery();

  AuthorAnswer edit(const OrderedJson& request);
  AuthorAnswer undo(const OrderedJson& request) { return step(request, -1); }
  AuthorAnswer redo(const OrderedJson& request) { return step(request, 1); }
  AuthorAnswer pose(const OrderedJson& request);
  AuthorAnswer posture(const OrderedJson& request);
  AuthorAnswer mirror(const OrderedJson& request);
  AuthorAnswer start_job(const OrderedJson& request);
  AuthorAnswer cancel_job(const std::string& id);

  /// The number of the next event.
  std::uint64_t next_event();
  /// The event with this number, if it comes within a fifth of a second.
  std::optional<AuthorEvent> wait_for_event(std::uint64_t number);

 private:
  struct View;
  using Shown = std::shared_ptr<const View>;
  using Stamps = std::map<std::filesystem::path, FileStamp>;

  Shown view();
  void follow();
  void refresh();
  void load_robot_of(const std::string& text, bool anew);
  bool robot_changed() const;
  bool is_gone();
  std::vector<std::filesystem::path> robot_files() const;
  Stamps stamps() const;
  void publish(std::shared_ptr<View> view);
  void tell(const std::string& name, const OrderedJson& data);
  AuthorAnswer step(const OrderedJson& request, int by);
  AuthorAnswer write(const std::string& seen, const std::string& text);
  AuthorAnswer conflict(const View& shown, const std::string& mine);
  void work(std::uint64_t id, std::string kind, OrderedJson options, Shown shown);

  const Context& context_;
  AuthorSetting setting_;

  std::mutex reading_;  ///< locked while the file is read or written
  std::optional<ShownRobot> robot_;
  Stamps seen_;
  /// Time of the last reading; empty after the file was checked a second time.
  std::optional<std::chrono::steady_clock::time_point> read_at_;
  std::optional<std::chrono::steady_clock::time_point> gone_since_;
  TextHistory history_;

  std::mutex state_;  ///< protects all members down to `first_event_`
  std::condition_variable changed_;
  Shown shown_;
  std::string model_;
  std::deque<AuthorEvent> events_;
  std::uint64_t first_event_ = 0;

  std::atomic<bool> stopping_ = false;

  std::mutex jobs_;  ///< protects the members of the job
  std::thread worker_;
  std::uint64_t job_ = 0;
  std::atomic<bool> job_runs_ = false, job_stops_ = false;

  std::thread follower_;
};

}  // namespace ayumi::app
