#include "repairing.hpp"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"

namespace ayumi::app {

namespace fs = std::filesystem;

namespace {

bool read_number(const std::string& word, double& value) {
  const char* end = word.data() + word.size();
  return !word.empty() && std::from_chars(word.data(), end, value).ptr == end;
}

[[noreturn]] void complain(const std::string& word, const std::string& why) {
  fail(ErrorCode::usage, "--lock '" + word + "': " + why);
}

void lock_keyframe(const std::string& word, const Pattern& pattern, RepairOptions& options) {
  double number = 0;
  const auto& keys = pattern.keyframes;
  if (!read_number(word.substr(9), number) || number != std::floor(number) || number < 0 ||
      number >= static_cast<double>(keys.size()))
    complain(word, keys.empty() ? "the pattern has no keyframes"
                                : "keyframes are numbered 0 to " + std::to_string(keys.size() - 1));
  const double t = keys[static_cast<size_t>(number)].t;
  options.locked_windows.emplace_back(t, t);
}

void lock_window(const std::string& word, double duration, RepairOptions& options) {
  const size_t dots = word.find("..");
  double begin = 0, end = 0;
  if (!read_number(word.substr(0, dots), begin) || !read_number(word.substr(dots + 2), end))
    complain(word, "a time window has the form BEGIN..END in seconds, for example 1.2..1.8");
  if (!(begin <= end)) complain(word, "the window must end after it begins");
  if (begin < 0 || begin > duration)
    complain(word, "the window must begin within the motion" +
                       (std::isfinite(duration) ? ", 0.." + text::exact(duration) + " s" : ""));
  options.locked_windows.emplace_back(begin, end);
}

// Relative names in the file are only valid from the folder for which they were written.
bool same_folder(const fs::path& a, const fs::path& b) {
  return fs::absolute(a).lexically_normal().parent_path() ==
         fs::absolute(b).lexically_normal().parent_path();
}

bool stays_inside(const fs::path& name) {
  const fs::path normal = name.lexically_normal();
  return normal.is_relative() && (normal.empty() || *normal.begin() != "..");
}

}  // namespace

void read_locks(const std::vector<std::string>& words, const Pattern& pattern, double duration,
                RepairOptions& options) {
  for (const std::string& word : words) {
    if (word == "foot:left" || word == "foot:right")
      options.locked_feet[word == "foot:left" ? 0 : 1] = true;
    else if (word.starts_with("foot:"))
      complain(word, "the feet are foot:left and foot:right");
    else if (word.starts_with("keyframe:"))
      lock_keyframe(word, pattern, options);
    else if (word.find("..") != std::string::npos)
      lock_window(word, duration, options);
    else
      options.locked_joints.push_back(word);
  }
}

bool write_with_companions(const Context& context, const std::string& from, const std::string& to,
                           const std::string& text) {
  if (same_folder(from, to)) {
    write_file(to, text);
    return true;
  }
  const auto json = nlohmann::json::parse(text, nullptr, true, true);
  const std::string robot = json.value("robot", std::string());
  if (robot.find('/') != std::string::npos && fs::path(robot).is_relative()) return false;
  std::vector<std::string> names;
  for (const char* key : {"table", "include"}) {
    if (!json.contains(key)) continue;
    if (json[key].is_string()) names.push_back(json[key]);
    if (json[key].is_array())
      for (const auto& name : json[key]) names.push_back(name);
  }
  std::vector<std::pair<fs::path, std::string>> companions;
  for (const std::string& name : names) {
    if (fs::path(name).is_absolute()) continue;
    if (!stays_inside(name)) return false;
    const fs::path target = fs::path(to).parent_path() / name;
    std::string bytes = read_file(fs::path(from).parent_path() / name);
    if (fs::exists(target)) {
      if (read_file(target) == bytes) continue;
      refuse_overwriting(context, target);
    }
    companions.emplace_back(target, std::move(bytes));
  }
  for (const auto& [target, bytes] : companions) {
    fs::create_directories(target.parent_path().empty() ? "." : target.parent_path());
    write_file(target, bytes);
  }
  write_file(to, text);
  return true;
}

}  // namespace ayumi::app
