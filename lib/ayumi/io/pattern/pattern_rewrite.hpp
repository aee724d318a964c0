#pragma once
// Writes the changes of an edited pattern into the text of its author. Comments, order, spacing,
// parameters, expressions, repeated blocks and included files stay where their values do not
// change. They also stay where the change can be written as an expression: an expression that
// changes its sign becomes "-(${stride})", and a time that is scaled becomes "(${lift_off})*1.25".

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "ayumi/motion/pattern.hpp"

namespace ayumi {

struct RewriteOptions {
  std::filesystem::path out = {};  ///< file of the new text; relative paths are valid from there
  std::map<std::string, double> set = {};  ///< parameters that were set when the text was read
  double time_scale = 1;                   ///< factor by which the edit multiplied all times
};

/// A text, and the pattern that it describes. Numbers that are added to expressions are rounded to
/// 1e-6, so values may differ from those of the edit by up to 2.5e-6 (as a share of values above
/// 1).
struct RewrittenPattern {
  std::string text;
  Pattern pattern;
};

/// `text` with the changes that lead from `before`, which was read from it, to `after`. Phases and
/// keyframes of `after` belong to those of the text that have the same pointer; those without a
/// pointer are new. A table is only named, not written. Nothing if the text cannot express the
/// changes, for example different changes of the rounds of a block that repeats.
std::optional<RewrittenPattern> rewritten(const std::string& text, const Pattern& before,
                                          const Pattern& after, const RewriteOptions& options);

/// What is in `text` but not in `kept`: comments, expressions, parameters, repeated blocks and
/// included files, each with its number, such as "3 comments". Both are texts of patterns. An
/// expression is kept if one with the same parameters is in its place.
std::vector<std::string> lost_marks(const std::string& text, const std::string& kept);

/// The lines, counted from 1, on which words that an edit does not change name a side. Such words
/// are in comments, in the name of the pattern, and in names of parameters and postures. A side is
/// named by "left", by "right", and by each of `sided_names`, such as the joints of one side.
/// `text` is the text of a pattern.
std::vector<int> lines_with_sides(const std::string& text,
                                  const std::set<std::string>& sided_names);

}  // namespace ayumi
