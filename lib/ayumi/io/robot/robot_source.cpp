#include "ayumi/io/robot/robot_source.hpp"

#include <algorithm>
#include <string_view>

#include "ayumi/base/error.hpp"
#include "ayumi/base/utf8.hpp"
#include "ayumi/io/robot/choreonoid_body.hpp"
#include "ayumi/io/robot/mjcf.hpp"
#include "ayumi/io/robot/sdf.hpp"
#include "ayumi/io/robot/urdf.hpp"
#include "ayumi/io/robot/ztk.hpp"

namespace ayumi {

namespace {

namespace fs = std::filesystem;

constexpr const char* kReadRobots =
    "Ayumi reads robots as URDF, MJCF, SDF, Choreonoid body and mi-lib ztk, and its own robot.json";
constexpr std::string_view kUtf8Mark = "\xef\xbb\xbf";

std::string robot_ending(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension;
}

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

std::string_view without_leading_blanks(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text;
}

// The name of the outermost element of an XML text; a declaration, comments and a document type may
// stand before it in any order. Empty if the text is not XML.
std::string outermost_element(std::string_view text) {
  while (true) {
    text = without_leading_blanks(text);
    if (text.size() < 2 || text[0] != '<') return {};
    std::string_view end = ">";
    if (text.starts_with("<!--"))
      end = "-->";
    else if (text[1] == '?')
      end = "?>";
    else if (text[1] != '!')
      break;
    const size_t at = text.find(end);
    if (at == std::string_view::npos) return {};
    text.remove_prefix(at + end.size());
  }
  const size_t stop = text.find_first_of(" \t\r\n/>");
  return std::string(text.substr(1, std::min(stop, text.size()) - 1));
}

[[noreturn]] void refuse_robot(const fs::path& path, const std::string& what) {
  fail(ErrorCode::bad_file, {path.string()}, what + "; " + kReadRobots);
}

}  // namespace

bool has_robot_ending(const fs::path& path) {
  static const std::vector<std::string> endings = {".urdf", ".xacro", ".xml", ".mjcf",
                                                   ".sdf",  ".body",  ".ztk"};
  return std::find(endings.begin(), endings.end(), robot_ending(path)) != endings.end();
}

RobotFormat robot_format(const std::string& bytes, const fs::path& path) {
  std::string_view text = bytes;
  const std::string extension = robot_ending(path);
  if (const std::string refusal = text::wide_encoding_refusal(bytes); !refusal.empty())
    refuse_robot(path, refusal);
  // Binary data has a zero byte early on.
  if (text.substr(0, 1024).find('\0') != std::string_view::npos)
    refuse_robot(path, "this is binary data, and not the text of a robot");
  if (text.starts_with(kUtf8Mark)) text.remove_prefix(kUtf8Mark.size());
  text = without_leading_blanks(text);
  if (text.empty() && (extension == ".body" || extension == ".ztk"))
    refuse_robot(path, "the file is empty");
  if (extension == ".json") return RobotFormat::sidecar;
  if (text.starts_with("<")) {
    const std::string name = outermost_element(text);
    if (name == "robot" || extension == ".urdf" || extension == ".xacro") return RobotFormat::urdf;
    if (name == "mujoco") return RobotFormat::mjcf;
    if (name == "sdf") return RobotFormat::sdf;
    if (name == "mujocoinclude")
      refuse_robot(path, "this is a part of an MJCF model; name the file that includes it");
    refuse_robot(path, name.empty() ? "this XML has no complete element"
                                    : "this is XML, but <" + name + "> is not a robot");
  }
  if (extension == ".urdf" || extension == ".xacro") return RobotFormat::urdf;
  if (text.starts_with("{") || text.starts_with("//") || text.starts_with("/*"))
    return RobotFormat::sidecar;
  // A body file has the word ChoreonoidBody in its first line that is not a remark.
  if (extension == ".body" || text.substr(0, 4096).find("ChoreonoidBody") != std::string_view::npos)
    return RobotFormat::body;
  if (extension == ".ztk" || text.substr(0, 4096).find("[roki::") != std::string_view::npos ||
      text.starts_with("[zeo::"))
    return RobotFormat::ztk;
  if (text.starts_with("#VRML")) refuse_robot(path, "this is a VRML model; convert it to URDF");
  refuse_robot(path, text.empty() ? "the file is empty" : "this is not a robot");
}

RobotDescription parse_robot(const std::string& bytes, const fs::path& path,
                             const std::vector<fs::path>& packages) {
  switch (robot_format(bytes, path)) {
    case RobotFormat::urdf:
      return parse_urdf(bytes, path, packages);
    case RobotFormat::mjcf:
      return parse_mjcf(bytes, path, packages);
    case RobotFormat::sdf:
      return parse_sdf(bytes, path, packages);
    case RobotFormat::body:
      return parse_choreonoid_body(bytes, path, packages);
    case RobotFormat::ztk:
      return parse_ztk(bytes, path);
    case RobotFormat::sidecar:
      break;
  }
  refuse_robot(path,
               "this is a sidecar, but a file with the links and joints of a robot is needed");
}

}  // namespace ayumi
