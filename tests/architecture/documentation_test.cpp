// The pages of docs name files, functions, tests, rooms and headings. Each of them must exist.
#include <gtest/gtest.h>

#include <cctype>
#include <sstream>

#include "tests/architecture/layers.hpp"

namespace ayumi::test {
namespace {

const fs::path kRoot = AYUMI_SOURCE_DIR;

std::string text_of(const fs::path& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string trimmed(const std::string& text) {
  const size_t begin = text.find_first_not_of(' ');
  return begin == std::string::npos ? ""
                                    : text.substr(begin, text.find_last_not_of(' ') - begin + 1);
}

/// The source files, below the folders `tops`, of a file that a page names without its extension.
std::vector<fs::path> sources_of(const std::string& name, const std::vector<std::string>& tops) {
  std::vector<fs::path> found;
  for (const std::string& top : tops)
    for (const char* extension : {"", ".cpp", ".hpp"})
      if (const fs::path file = kRoot / top / (name + extension); fs::is_regular_file(file))
        found.push_back(file);
  return found;
}

/// The places where `name(` stands in a text and is not the end of a longer name.
std::vector<size_t> calls_of(const std::string& name, const std::string& text) {
  std::vector<size_t> found;
  for (size_t at = text.find(name + "("); at != std::string::npos;
       at = text.find(name + "(", at + 1))
    if (at == 0 || (!std::isalnum(static_cast<unsigned char>(text[at - 1])) && text[at - 1] != '_'))
      found.push_back(at);
  return found;
}

/// The position behind the bracket that closes the one at `open`.
size_t closing(const std::string& text, size_t open, char left, char right) {
  int depth = 0;
  for (size_t i = open; i < text.size(); ++i) {
    if (text[i] == left) ++depth;
    if (text[i] == right && --depth == 0) return i + 1;
  }
  return text.size();
}

/// The bodies of all functions of this name that the text defines.
std::string bodies_of(const std::string& name, const std::string& text) {
  std::string bodies;
  for (const size_t at : calls_of(name, text)) {
    const size_t end = closing(text, at + name.size(), '(', ')');
    const size_t brace = text.find_first_not_of(" \n", end);
    const size_t open =
        text.compare(brace, 5, "const") == 0 ? text.find_first_not_of(" \n", brace + 5) : brace;
    if (open == std::string::npos || text[open] != '{') continue;
    bodies += text.substr(open, closing(text, open, '{', '}') - open);
  }
  return bodies;
}

/// A cell of the map, which has the form "`function`, `function` in `file`".
struct Place {
  std::vector<std::string> names;
  std::string file;
};

Place place_of(const std::string& cell) {
  Place place;
  static const std::regex quoted("`([^`]+)`");
  for (std::sregex_iterator i(cell.begin(), cell.end(), quoted), end; i != end; ++i)
    place.names.push_back((*i)[1]);
  if (place.names.size() > 1) {
    place.file = place.names.back();
    place.names.pop_back();
  }
  return place;
}

/// The cells of every row of the first table below a heading.
std::vector<std::vector<std::string>> table_below(const fs::path& page,
                                                  const std::string& heading) {
  std::vector<std::vector<std::string>> rows;
  bool below = false;
  for (const std::string& line : lines_of(page)) {
    if (line.starts_with("#")) {
      if (below && !rows.empty()) break;
      below = line.find(heading) != std::string::npos;
    }
    if (!below || !line.starts_with("|")) continue;
    std::vector<std::string> cells;
    std::istringstream stream(line.substr(1));
    for (std::string cell; std::getline(stream, cell, '|');) cells.push_back(trimmed(cell));
    rows.push_back(cells);
  }
  // The head of the table and the rule below it are removed.
  if (rows.size() > 2) rows.erase(rows.begin(), rows.begin() + 2);
  return rows;
}

std::string all_sources() {
  std::string all;
  for (const char* top : {"lib/ayumi", "app"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top))
      if (entry.path().extension() == ".cpp") all += text_of(entry.path());
  return all;
}

// The functions of the map are used: their callers call them, and something else calls the callers.
TEST(Documentation, TheMapOfEquationsLeadsToTheFunctionsThatRun) {
  const auto rows = table_below(kRoot / "docs/theory.md", "Map");
  ASSERT_GT(rows.size(), 12u);
  const std::string everything = all_sources();
  for (const auto& row : rows) {
    ASSERT_EQ(row.size(), 5u) << row[0];
    SCOPED_TRACE(row[0]);
    const Place function = place_of(row[2]), caller = place_of(row[3]), test = place_of(row[4]);
    for (const Place& place : {function, caller, test}) ASSERT_FALSE(place.file.empty());
    std::string defining, calling, testing;
    for (const auto& file : sources_of(function.file, {"lib/ayumi"})) defining += text_of(file);
    for (const auto& file : sources_of(caller.file, {"lib/ayumi", "app"})) calling += text_of(file);
    for (const auto& file : sources_of(test.file, {"tests"})) testing += text_of(file);
    std::string bodies;
    for (const std::string& name : caller.names) {
      const std::string body = bodies_of(name, calling);
      EXPECT_FALSE(body.empty()) << caller.file << " does not define " << name;
      EXPECT_GE(calls_of(name, everything).size(), 2u) << "nothing calls " << name;
      bodies += body;
    }
    for (const std::string& name : function.names) {
      EXPECT_FALSE(bodies_of(name, defining).empty())
          << function.file << " does not define " << name;
      EXPECT_FALSE(calls_of(name, bodies).empty()) << "the caller does not call " << name;
    }
    for (const std::string& name : test.names)
      EXPECT_NE(testing.find(", " + name + ")"), std::string::npos)
          << "no test " << name << " in " << test.file;
  }
}

const std::vector<std::string>& pages() {
  static const std::vector<std::string> names = {
      "theory.md",        "theory_baselines.md", "theory_estimator.md", "theory_flight.md",
      "theory_gains.md",  "theory_plant.md",     "theory_pushes.md",    "theory_repair.md",
      "theory_timing.md", "notation.md",         "architecture.md"};
  return names;
}

TEST(Documentation, FilesNamedOnThePagesExist) {
  static const std::regex path("`([a-z][a-z0-9_]*(?:/[A-Za-z0-9_.]+)+/?)`");
  for (const std::string& page : pages()) {
    const std::string text = text_of(kRoot / "docs" / page);
    EXPECT_FALSE(text.empty()) << page;
    for (std::sregex_iterator i(text.begin(), text.end(), path), end; i != end; ++i) {
      const std::string name = (*i)[1];
      bool exists = !sources_of(name, {"", "lib/ayumi", "tests"}).empty();
      for (const char* top : {"", "lib/ayumi", "tests"})
        exists |= fs::is_directory(kRoot / top / name);
      EXPECT_TRUE(exists) << page << " names " << name;
    }
  }
}

TEST(Documentation, TheRoomsOfTheArchitecturePageAreThoseOfTheTable) {
  std::map<std::string, int> described, known;
  for (const auto& row : table_below(kRoot / "docs/architecture.md", "Rooms")) {
    ASSERT_GT(row.size(), 2u);
    std::string name = row[1];
    name.erase(std::remove(name.begin(), name.end(), '`'), name.end());
    described[name] = std::stoi(row[0]);
  }
  for (const auto& [name, room] : rooms()) known[name] = room.floor;
  EXPECT_EQ(described, known);
}

std::set<std::string> headings_of(const fs::path& page) {
  std::set<std::string> found;
  bool fenced = false;
  for (const std::string& line : lines_of(page)) {
    if (line.starts_with("```")) fenced = !fenced;
    const size_t text = line.find_first_not_of("# ");
    if (!fenced && line.starts_with("#") && text != std::string::npos)
      found.insert(line.substr(text));
  }
  return found;
}

/// The heading may be a heading or the bold first words of a paragraph.
bool has_heading(const fs::path& page, const std::string& heading) {
  return headings_of(page).contains(heading) ||
         text_of(page).find("**" + heading + ".**") != std::string::npos;
}

// A comment names a heading as in "docs/theory_gains.md, "Gain design"", which may continue in the
// next line.
TEST(Documentation, HeadingsNamedInSourcesExist) {
  static const std::regex citation(R"re(docs/(\w+\.md), "([^"]+)")re"),
      comment_break(R"(\n\s*///? ?)");
  for (const char* top : {"lib/ayumi", "app", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(kRoot / top)) {
      const std::string extension = entry.path().extension();
      if (extension != ".cpp" && extension != ".hpp") continue;
      if (entry.path().filename() == "documentation_test.cpp") continue;
      const std::string source = text_of(entry.path());
      if (source.find("docs/") == std::string::npos) continue;
      const std::string text = std::regex_replace(source, comment_break, " ");
      for (std::sregex_iterator i(text.begin(), text.end(), citation), end; i != end; ++i)
        EXPECT_TRUE(has_heading(kRoot / "docs" / (*i)[1].str(), (*i)[2]))
            << entry.path() << " cites " << (*i)[0];
    }
}

}  // namespace
}  // namespace ayumi::test
