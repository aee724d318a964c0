#include "ayumi/io/robot/xml_text.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

#include "ayumi/base/error.hpp"
#include "ayumi/base/shortened_text.hpp"

namespace ayumi {

namespace {

// Largest depth of nested elements. Chosen: a URDF needs five, and the stack holds far more.
constexpr int kDeepestXml = 200;

// Largest number of attributes of an element. Chosen: URDF knows at most eight; TinyXML compares
// all attributes of an element with each other.
constexpr int kMostAttributes = 100;

// TinyXML descends by recursion, so a text is refused if it is nested more deeply than any robot's
// file.
void refuse_deep_nesting(const std::string& bytes, const std::string& file,
                         const std::string& kind) {
  int depth = 0;
  for (size_t i = 0; i + 1 < bytes.size(); ++i) {
    if (bytes[i] == '<' && bytes[i + 1] == '/') --depth;
    if (bytes[i] == '<' && bytes[i + 1] != '/' && bytes[i + 1] != '!' && bytes[i + 1] != '?')
      ++depth;
    if (bytes[i] == '/' && bytes[i + 1] == '>') --depth;
    if (depth > kDeepestXml)
      fail(ErrorCode::bad_file, {file},
           "elements are nested more than " + std::to_string(kDeepestXml) +
               " levels deep, too deep for " + kind);
  }
}

// Each '=' outside quotation marks stands for one attribute.
void refuse_many_attributes(const std::string& bytes, const std::string& file) {
  int line = 1, count = 0;
  char quote = 0;
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (bytes[i] == '\n') ++line;
    if (quote != 0) {
      if (bytes[i] == quote) quote = 0;
      continue;
    }
    if (bytes.compare(i, 4, "<!--") == 0) {
      const size_t end = std::min(bytes.find("-->", i + 4), bytes.size());
      line += static_cast<int>(std::count(bytes.begin() + i, bytes.begin() + end, '\n'));
      i = end;
      continue;
    }
    if (bytes[i] == '<') count = 0;
    if (bytes[i] != '=') continue;
    if (++count > kMostAttributes)
      fail(ErrorCode::bad_file, {file, "", line},
           "an element has more than " + std::to_string(kMostAttributes) + " attributes");
    size_t value = i + 1;
    while (value < bytes.size() && std::isspace(static_cast<unsigned char>(bytes[value]))) ++value;
    if (value >= bytes.size() || (bytes[value] != '"' && bytes[value] != '\'')) continue;
    line += static_cast<int>(std::count(bytes.begin() + i + 1, bytes.begin() + value, '\n'));
    quote = bytes[value];
    i = value;
  }
}

}  // namespace

void parse_xml(TiXmlDocument& document, const std::string& bytes, const std::string& file,
               const std::string& kind) {
  const bool blank =
      std::all_of(bytes.begin(), bytes.end(), [](unsigned char c) { return std::isspace(c); });
  if (blank) fail(ErrorCode::bad_file, {file}, "the file is empty, but " + kind + " is needed");
  refuse_deep_nesting(bytes, file, kind);
  refuse_many_attributes(bytes, file);
  document.Parse(bytes.c_str(), nullptr, TIXML_ENCODING_UTF8);
  if (document.Error() && !document.RootElement())
    fail(ErrorCode::bad_file, {file},
         std::string("this is not XML (") + document.ErrorDesc() + "); " + kind + " is needed");
  if (document.Error()) {
    // The parser does not know the row if the text ends within an element.
    const auto rows = 1 + std::count(bytes.begin(), bytes.end(), '\n');
    const int row = document.ErrorRow() > 0 ? document.ErrorRow() : static_cast<int>(rows);
    fail(ErrorCode::bad_file, {file, "", row},
         std::string("this is not valid XML (") + document.ErrorDesc() +
             "); correct this place, or copy the file again if it was cut off");
  }
  if (!document.RootElement())
    fail(ErrorCode::bad_file, {file},
         "this is not XML, because it has no element; " + kind + " is needed");
}

void complain_xml(const std::string& file, const TiXmlElement* at, const std::string& message) {
  fail(ErrorCode::bad_file, {file, "", at->Row()}, message);
}

std::string xml_attribute(const TiXmlElement* element, const char* name, const std::string& other) {
  const char* value = element ? element->Attribute(name) : nullptr;
  return value ? value : other;
}

std::string shown_value(const std::string& value) {
  constexpr size_t kMost = 80;  // bytes. Chosen: nine numbers with six digits
  std::string shown;
  for (const char c : value.substr(0, kMost + 1))
    shown += std::isspace(static_cast<unsigned char>(c)) ? ' ' : c;
  return text::shortened(shown, [](const std::string& each) { return each.size() <= kMost; });
}

std::vector<double> xml_numbers(const std::string& file, const TiXmlElement* at,
                                const std::string& place, const std::string& text, int count) {
  std::vector<double> values;
  const char* here = text.data();
  const char* const end = here + text.size();
  while (true) {
    while (here != end && std::isspace(static_cast<unsigned char>(*here))) ++here;
    if (here == end) break;
    const char* const word = here;
    if (*here == '+') ++here;
    double value = 0;
    const auto [stop, error] = std::from_chars(here, end, value);
    const bool whole = stop == end || std::isspace(static_cast<unsigned char>(*stop));
    if (error != std::errc() || !whole || !std::isfinite(value)) {
      const std::string shown = shown_value(
          {word, std::find_if(word, end, [](unsigned char c) { return std::isspace(c); })});
      complain_xml(file, at,
                   place + "'" + shown + "' is not a finite number" +
                       (shown.find(',') != std::string::npos
                            ? "; numbers have a decimal point, and blanks between them"
                            : ""));
    }
    here = stop;
    values.push_back(value);
  }
  if (static_cast<int>(values.size()) != count)
    complain_xml(file, at,
                 place + std::to_string(count) + " numbers are needed, found " +
                     std::to_string(values.size()));
  return values;
}

}  // namespace ayumi
