#include "ayumi/io/json/document_format.hpp"

#include <map>

namespace ayumi {

namespace {

struct KnownFormat {
  const char* what;
  const char* command;  ///< what reads it, with FILE for its name
};

const std::map<std::string, KnownFormat>& known_formats() {
  static const std::map<std::string, KnownFormat> known = {
      {"ayumi.pattern/1", {"a pattern", "ayumi check FILE"}},
      {"ayumi.postures/1", {"a library of postures", "ayumi posture list FILE"}},
      {"ayumi.robot/1", {"a robot", "ayumi inspect FILE"}},
      {"ayumi.study/1", {"a study", "ayumi certify PATTERN --study FILE"}},
      {"ayumi.run/1", {"the list of a run's files", "ayumi report FOLDER"}},
      {"ayumi.push/1", {"the result of a push study", "ayumi report FOLDER --push FILE"}}};
  return known;
}

}  // namespace

void require_format(const JsonNode& root, const std::string& format) {
  const JsonNode node = root.at("format");
  const std::string found = node.string();
  if (found == format) return;
  const auto wanted = known_formats().find(format), is = known_formats().find(found);
  if (wanted == known_formats().end() || is == known_formats().end())
    node.complain("'" + found + "' cannot be read; this version of Ayumi reads '" + format + "'");
  node.complain(std::string("this file is ") + is->second.what + ", which `" + is->second.command +
                    "` reads; " + wanted->second.what + " is needed here",
                true);
}

}  // namespace ayumi
