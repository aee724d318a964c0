#include "ayumi/report/html.hpp"

#include <cstdint>

#include "ayumi/base/text.hpp"

namespace ayumi::html {

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(4 * ((bytes.size() + 2) / 3));
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const size_t count = bytes.size() - i < 3 ? bytes.size() - i : 3;
    std::uint32_t word = 0;
    for (size_t k = 0; k < 3; ++k)
      word = word << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string quoted(const std::string& text) {
  constexpr const char* kHex = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (byte < 0x20 || c == '<' || c == '>' || c == '&')
      out += std::string("\\u00") + kHex[byte / 16] + kHex[byte % 16];
    else
      out += c;
  }
  return out + '"';
}

namespace {

/// Whether a cell is a number. Without heads, the number may have a unit; below a column head, it
/// may not.
bool is_number(const std::string& cell, bool with_heads) {
  constexpr const char* kBegin = "0123456789+-.";
  if (cell.empty() || std::string(kBegin).find(cell[0]) == std::string::npos) return false;
  return !with_heads || cell.find_first_not_of("0123456789+-.e") == std::string::npos;
}

}  // namespace

std::string table(const Table& table) {
  // On a narrow page, the table scrolls sideways, also with the keyboard.
  std::string out = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" +
                    escaped(table.caption.empty() ? "Table" : table.caption) + "\"><table>\n";
  if (!table.caption.empty())
    out += "<caption><span>" + escaped(table.caption) + "</span></caption>\n";
  if (!table.head.empty()) {
    out += "<tr>";
    for (const std::string& name : table.head)
      out += "<th scope=\"col\">" + escaped(name) + "</th>";
    out += "</tr>\n";
  }
  for (const std::vector<std::string>& row : table.rows) {
    out += "<tr>";
    for (size_t i = 0; i < row.size(); ++i) {
      const bool number = is_number(row[i], !table.head.empty());
      if (i == 0)
        out += "<th scope=\"row\">" + row[i] + "</th>";
      else
        out += (number ? "<td class=\"number\">" : "<td>") + row[i] + "</td>";
    }
    out += "</tr>\n";
  }
  return out + "</table></div>\n";
}

std::string time_link(double t) {
  const std::string words = text::fixed(t, 3);
  return "<a href=\"#stage\" data-time=\"" + words + "\">" + words + "</a>";
}

std::string section(const std::string& id, const std::string& title, const std::string& contents) {
  return "<section id=\"" + id + "\" aria-labelledby=\"" + id + "-title\">\n<h2 id=\"" + id +
         "-title\">" + escaped(title) + "</h2>\n" + contents + "</section>\n";
}

}  // namespace ayumi::html
