#include "ayumi/limits/finding.hpp"

#include <algorithm>

namespace ayumi {

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    default:
      return "info";
  }
}

const std::vector<std::string>& finding_kind_names() {
#define AYUMI_NAME(kind, limit) #kind,
  static const std::vector<std::string> names = {AYUMI_FINDING_KINDS(AYUMI_NAME)};
#undef AYUMI_NAME
  return names;
}

const char* name_of(FindingKind kind) {
  return finding_kind_names()[static_cast<size_t>(kind)].c_str();
}

std::optional<FindingKind> finding_kind(std::string_view name) {
  const std::vector<std::string>& names = finding_kind_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<FindingKind>(found - names.begin());
}

int dof_of(const Finding& finding) {
  const JointPlace* joint = std::get_if<JointPlace>(&finding.place);
  return joint ? joint->dof : -1;
}

std::string place_words(const std::string& where, bool with_article) {
  struct Words {
    std::string_view name, article, words;
  };
  constexpr Words kWords[] = {{"left", "the ", "left foot"}, {"right", "the ", "right foot"},
                              {"both", "", "both feet"},     {"none", "", "no foot"},
                              {"x", "the ", "x axis"},       {"y", "the ", "y axis"},
                              {"z", "the ", "z axis"}};
  for (const Words& each : kWords)
    if (where == each.name || where.starts_with(std::string(each.name) + " with "))
      return std::string(with_article ? each.article : "") + std::string(each.words) +
             where.substr(each.name.size());
  return where;
}

}  // namespace ayumi
