#include "ayumi/io/json/json_slip.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>
#include <vector>

#include "ayumi/io/json/json_text.hpp"

namespace ayumi {

namespace {

// Largest number of characters of a word or number that a message quotes. Chosen: a line of a
// terminal holds the message with it.
constexpr size_t kQuoted = 24;

enum class Token { end, open, close, comma, colon, string, number, word, other };

bool is_word_char(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_' || (c & 0x80) != 0;
}
bool is_decimal(char c) { return c >= '0' && c <= '9'; }

// Characters of a number, or of a word that resembles a number.
bool continues_number(char c) {
  return is_decimal(c) || is_word_char(c) || c == '.' || c == '+' || c == '-';
}

bool is_json_number(std::string_view number) {
  size_t i = 0;
  const auto digits = [&] {
    const size_t begin = i;
    while (i < number.size() && is_decimal(number[i])) ++i;
    return i > begin;
  };
  if (i < number.size() && number[i] == '-') ++i;
  const bool zero = i < number.size() && number[i] == '0';
  const size_t whole = i;
  if (!digits() || (zero && i - whole > 1)) return false;
  if (i < number.size() && number[i] == '.') {
    ++i;
    if (!digits()) return false;
  }
  if (i < number.size() && (number[i] == 'e' || number[i] == 'E')) {
    ++i;
    if (i < number.size() && (number[i] == '+' || number[i] == '-')) ++i;
    if (!digits()) return false;
  }
  return i == number.size();
}

// The quotation marks of other programs: typographic ones and the grave accent.
constexpr std::array<std::string_view, 7> kOtherQuotes = {"\xe2\x80\x9c",
                                                          "\xe2\x80\x9d",
                                                          "\xe2\x80\x9e",
                                                          "\xe2\x80\x98",
                                                          "\xe2\x80\x99",
                                                          "\xc2\xab",
                                                          "`"};

size_t other_quote(std::string_view text, size_t at) {
  for (const std::string_view mark : kOtherQuotes)
    if (text.substr(at, mark.size()) == mark) return mark.size();
  return text.substr(at, 1) == "'" ? 1 : 0;
}

// Words that Python, JavaScript and YAML have for values.
std::string json_word(std::string_view word) {
  std::string low;
  for (const char c : word) low += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (low == "true" || low == "yes" || low == "on") return "true";
  if (low == "false" || low == "no" || low == "off") return "false";
  if (low == "none" || low == "null" || low == "nil") return "null";
  return "";
}

// An open bracket, and what was read last inside it.
struct Open {
  char bracket = '{';
  size_t at = 0;
  enum class Expects { first, item, colon, value, comma } expects = Expects::first;
};

class SlipFinder {
 public:
  explicit SlipFinder(const std::string& text) : text_(text) {}

  std::optional<JsonSlip> find() {
    open_.push_back({'\0', 0, Open::Expects::value});  // the text itself
    for (next(); !slip_ && token_ != Token::end; next()) {
      if (opens_in_word())
        say_unclosed(last_at_);
      else
        take();
      last_at_ = at_;
      last_ = token_;
    }
    if (!slip_ && token_ == Token::end) take_end();
    return slip_;
  }

 private:
  using Expects = Open::Expects;

  // ---- tokens

  void say(size_t at, std::string words, bool in_number = false) {
    if (!slip_) slip_ = JsonSlip{at, std::move(words), in_number};
  }

  std::string_view from(size_t at) const { return std::string_view(text_).substr(at); }

  std::string quoted(size_t begin, size_t end) const {
    if (end - begin <= kQuoted) return text_.substr(begin, end - begin);
    size_t cut = begin + kQuoted;  // the cut is not inside a letter of several bytes
    while (cut > begin && (text_[cut] & 0xc0) == 0x80) --cut;
    return text_.substr(begin, cut - begin) + "...";
  }

  std::string token_words() const { return quoted(at_, end_); }

  std::string bracket_words(const Open& open) const {
    return std::string("the ") + open.bracket + " of line " +
           std::to_string(line_at(text_, open.at));
  }

  static char closing(char bracket) { return bracket == '{' ? '}' : ']'; }

  // Whether the quotation mark that should open this word has closed the string before it, as in
  // `"t: 0.5, "zmp"`, where the mark after t is missing.
  bool opens_in_word() const {
    return token_ == Token::word && last_ == Token::string && text_[at_ - 1] == '"';
  }

  // Says that a quotation mark is missing at the end of the string that begins at `begin`. The
  // string ends before the next character that separates values.
  void say_unclosed(size_t begin) {
    size_t end = begin + 1;
    while (end < text_.size() &&
           std::string_view(",:]}\"\r\n").find(text_[end]) == std::string_view::npos)
      ++end;
    const size_t word = text_.find_last_not_of(" \t", end - 1) + 1;
    say(end, "a quotation mark is missing at the end of " + quoted(begin, word));
  }

  // Reads the next token. Reports what is wrong if the token is not JSON.
  void next() {
    before_ = end_;
    skip();
    if (slip_) return;
    at_ = end_;
    if (at_ >= text_.size()) {
      token_ = Token::end;
      return;
    }
    const char c = text_[at_];
    end_ = at_ + 1;
    if (c == '{' || c == '[') {
      token_ = Token::open;
    } else if (c == '}' || c == ']') {
      token_ = Token::close;
    } else if (c == ',') {
      token_ = Token::comma;
    } else if (c == ':') {
      token_ = Token::colon;
    } else if (c == '"') {
      token_ = Token::string;
      read_string();
    } else if (is_decimal(c) || c == '-' || c == '+' || (c == '.' && is_decimal(text_[at_ + 1]))) {
      token_ = Token::number;
      while (end_ < text_.size() && continues_number(text_[end_])) ++end_;
    } else if (other_quote(text_, at_) > 0) {
      say(at_, "names and words need straight quotation marks: \"...\", not " +
                   text_.substr(at_, other_quote(text_, at_)));
    } else if (from(at_).starts_with("\xc2\xa0")) {
      say(at_, "there is a no-break space here; write a normal space");
    } else if (is_word_char(c) || c == '$') {
      token_ = Token::word;
      read_word();
    } else {
      token_ = Token::other;
    }
  }

  // Skips spaces and comments. `end_` is after them.
  void skip() {
    while (end_ < text_.size()) {
      const char c = text_[end_];
      if (std::isspace(static_cast<unsigned char>(c))) {
        ++end_;
      } else if (from(end_).starts_with("//")) {
        while (end_ < text_.size() && text_[end_] != '\n') ++end_;
      } else if (from(end_).starts_with("/*")) {
        const size_t close = text_.find("*/", end_ + 2);
        if (close == std::string::npos) return say(end_, "this comment has no end: */ is missing");
        end_ = close + 2;
      } else if (end_ == 0 && from(0).starts_with("\xef\xbb\xbf")) {
        end_ = 3;  // the byte order mark of UTF-8
      } else {
        return;
      }
    }
  }

  void read_string() {
    for (; end_ < text_.size(); ++end_) {
      const char c = text_[end_];
      if (c == '"') {
        ++end_;
        return;
      }
      if (c == '\n' || c == '\r') break;
      if (static_cast<unsigned char>(c) < 0x20)
        return say(end_,
                   "there is a tab or another invisible character between quotation marks; "
                   "write a space");
      if (c != '\\') continue;
      if (end_ + 1 < text_.size() &&
          std::string_view("\"\\/bfnrtu").find(text_[end_ + 1]) == std::string_view::npos)
        return say(end_,
                   "in a text between quotation marks, write each backslash twice: \\\\ (in the "
                   "name of a file, you can write / instead)");
      ++end_;
    }
    say_unclosed(at_);
  }

  // Reads a word. An expression such as ${stride} * 2 belongs to one token as a whole.
  void read_word() {
    int open = 0;  // number of open braces of ${...}
    for (; end_ < text_.size(); ++end_) {
      const char c = text_[end_];
      if (c == '{' && text_[end_ - 1] == '$')
        ++open;
      else if (c == '}' && open > 0)
        --open;
      else if (!is_word_char(c) && !is_decimal(c) && c != '$' && c != '.')
        return;
    }
  }

  // ---- grammar

  Open& inside() { return open_.back(); }

  // What may follow after a value or bracket that is complete.
  void completed() {
    value_begin_ = at_;
    inside().expects = Expects::comma;
  }

  bool at_top() const { return open_.size() == 1; }

  void take() {
    if (slip_) return;
    switch (inside().expects) {
      case Expects::first:
        if (closes()) return;
        return take_item(false);
      case Expects::item:
        return take_item(true);
      case Expects::colon:
        return take_colon();
      case Expects::value:
        return take_value();
      case Expects::comma:
        return take_comma();
    }
  }

  // Closes the innermost bracket if the token is its closing bracket.
  bool closes() {
    if (token_ != Token::close) return false;
    if (at_top()) {
      say(at_, std::string("this ") + text_[at_] +
                   " closes nothing, because no bracket is open; remove this bracket");
      return true;
    }
    if (text_[at_] != closing(inside().bracket)) {
      const char wanted = closing(inside().bracket);
      say(at_, bracket_words(inside()) + " is not closed before this " + text_[at_] + ". Write a " +
                   wanted + " before this " + text_[at_] + ", or remove this " + text_[at_] +
                   ", or replace this " + text_[at_] + " by a " + wanted);
      return true;
    }
    if (!doubtful_ && stands_left_of(inside().at)) doubtful_ = inside().at;
    open_.pop_back();
    completed();
    return true;
  }

  // Whether this bracket begins a line that is indented less than the line of the bracket that it
  // closes. A line is examined only for a bracket that begins the line, because a long line may
  // have many brackets.
  bool stands_left_of(size_t opening) const {
    const auto is_blank = [&](size_t at) { return text_[at] == ' ' || text_[at] == '\t'; };
    size_t line = at_;
    while (line > 0 && is_blank(line - 1)) --line;
    if (line > 0 && text_[line - 1] != '\n') return false;
    const size_t other = opening == 0 ? 0 : text_.rfind('\n', opening - 1) + 1;
    size_t word = other;
    while (is_blank(word)) ++word;
    return at_ - line < word - other;
  }

  void take_item(bool after_comma) {
    if (after_comma && token_ == Token::close) {
      const size_t comma = text_.rfind(',', at_);
      return say(comma,
                 std::string("this comma is followed by a ") + text_[at_] + "; remove the comma");
    }
    if (token_ == Token::comma)
      return say(at_, after_comma ? "there are two commas in a row; remove one"
                                  : "there is nothing before this comma; remove the comma");
    if (inside().bracket == '[') return take_value();
    if (token_ == Token::string) {
      name_at_ = at_;
      name_end_ = end_;
      inside().expects = Expects::colon;
      return;
    }
    take_name(after_comma);
  }

  // Reports a token that is not a name in quotation marks, where an object needs a name.
  void take_name(bool after_comma) {
    if (token_ == Token::word) {
      if (text_[end_] == '"')
        return say(at_, "a quotation mark is missing before " + token_words());
      return say(at_,
                 "the name " + token_words() + " needs quotation marks: \"" + token_words() + "\"");
    }
    if (token_ == Token::open && after_comma)
      return say(before_value(), bracket_words(inside()) +
                                     " is not closed: a } is missing before "
                                     "the comma");
    if (token_ == Token::colon) return say(at_, "the name before this colon is missing");
    if (token_ == Token::number && text_[at_ - 1] == ',' && is_decimal(text_[at_]) &&
        is_decimal(text_[at_ - 2]))
      return say(at_ - 1, "a number has a decimal point, not a comma", true);
    if (token_ == Token::number)
      return say(at_, token_words() +
                          " has no name: in { } every value has a name, as in "
                          "\"t\": 0.5 (a list of values is written in [ ])");
    say_other();
  }

  // The end of the token before the last comma.
  size_t before_value() const {
    const size_t comma = text_.rfind(',', at_);
    return comma == std::string::npos ? at_ : comma;
  }

  void take_colon() {
    if (token_ == Token::colon) {
      inside().expects = Expects::value;
      return;
    }
    const std::string name = quoted(name_at_, name_end_);
    if (token_ == Token::other && text_[at_] == '=')
      return say(at_, "write a colon after the name " + name + ", not =");
    if (token_ == Token::comma || token_ == Token::close)
      return say(before_, "the name " + name +
                              " has no value: a colon and a value are missing "
                              "after it (a list of values is written in [ ])");
    say(before_, "a colon is missing after the name " + name);
  }

  void take_value() {
    switch (token_) {
      case Token::string:
        return completed();
      case Token::open:
        open_.push_back({text_[at_], at_, Expects::first});
        return;
      case Token::number:
        return take_number();
      case Token::word:
        return take_word();
      case Token::comma:
      case Token::close:
        if (inside().bracket == '{')
          return say(before_, "the value of the name " + quoted(name_at_, name_end_) +
                                  " is missing after its colon");
        closes();
        return;
      case Token::colon:
        return say(at_, "there are two colons in a row; remove one");
      default:
        return say_other();
    }
  }

  void take_number() {
    const std::string number = token_words();
    if (is_json_number(std::string_view(text_).substr(at_, end_ - at_))) return completed();
    if (number.front() == '+')
      return say(at_, "a number must not begin with +: write " + number.substr(1));
    if (number.front() == '.' || number.starts_with("-."))
      return say(at_,
                 "a number needs a digit before its decimal point: write " +
                     (number.front() == '.' ? "0" + number : "-0" + number.substr(1)),
                 true);
    if (number.back() == '.')
      return say(at_,
                 "a number needs a digit after its decimal point: write " +
                     number.substr(0, number.size() - 1) + " or " + number + "0",
                 true);
    size_t unit = 0;
    while (unit < number.size() && !is_word_char(number[unit])) ++unit;
    if (unit > 0 && unit < number.size() && is_json_number(number.substr(0, unit)))
      return say(at_,
                 "'" + number + "' is not a number: write " + number.substr(0, unit) + " without " +
                     number.substr(unit) +
                     ". Numbers are written without a unit, because the file states its units; an "
                     "expression needs quotation marks");
    if (number.size() > 1 && number.front() == '0' && is_decimal(number[1])) {
      if (at_ > 1 && text_[at_ - 1] == ',' && is_decimal(text_[at_ - 2]))
        return say(at_ - 1, "a number has a decimal point, not a comma", true);
      return say(at_, "a number must not begin with an extra 0: " + number);
    }
    say(at_, "'" + number + "' is not a number (an expression needs quotation marks)");
  }

  void take_word() {
    const std::string word = text_.substr(at_, end_ - at_);
    if (word == "true" || word == "false" || word == "null") return completed();
    const std::string meant = json_word(word);
    if (!meant.empty()) return say(at_, token_words() + " is written as " + meant);
    if (word.find("${") != std::string::npos)
      return say(at_, "an expression needs quotation marks: \"" + token_words() + "\"");
    if (end_ < text_.size() && text_[end_] == '"')
      return say(at_, "a quotation mark is missing before " + token_words());
    if (word == "NaN" || word == "Infinity" || word == "inf" || word == "nan")
      return say(at_, token_words() + " is not a number");
    say(at_, "the word " + token_words() + " needs quotation marks: \"" + token_words() + "\"");
  }

  void take_comma() {
    if (token_ == Token::comma && !at_top()) {
      inside().expects = Expects::item;
      return;
    }
    if (at_top()) {
      if (token_ == Token::close)
        return say(at_,
                   std::string("this ") + text_[at_] +
                       " closes nothing, because all brackets are closed; remove this bracket");
      return say(
          at_,
          "the text continues after its last bracket is closed. If a closing bracket before "
          "this place is wrong, remove that bracket; otherwise remove the text from here on");
    }
    if (token_ == Token::close) {
      closes();
      return;
    }
    if (token_ == Token::colon && inside().bracket == '[')
      return say(at_, "a name with a value must be in { }, but the innermost open bracket is " +
                          bracket_words(inside()) +
                          ". A ] is missing before the name, or a { is missing before the name");
    if (token_ == Token::colon) return say(at_, "a comma is meant here, not a colon");
    if (token_ == Token::other && text_[at_] == ';')
      return say(at_, "a comma is meant here, not a semicolon");
    if (token_ == Token::other) return say_other();
    const bool name = token_ == Token::string && skipped_to(end_) == ':';
    if (inside().bracket == '[' && name)
      return say(before_, bracket_words(inside()) +
                              " is not closed: a ] and a comma are missing before the name " +
                              token_words());
    if (inside().bracket == '{' && token_ == Token::open)
      return say(before_, bracket_words(inside()) +
                              " is not closed: a } and a comma are missing before this " +
                              text_[at_]);
    say(before_, "a comma is missing after " + quoted(value_begin_, before_));
  }

  // The next character that is not a space.
  char skipped_to(size_t at) const {
    while (at < text_.size() && std::isspace(static_cast<unsigned char>(text_[at]))) ++at;
    return at < text_.size() ? text_[at] : '\0';
  }

  void say_other() {
    if (token_ == Token::other && text_[at_] == '#')
      return say(at_, "a comment begins with //, not with #");
    if (token_ == Token::other && text_[at_] == '(')
      return say(at_, "a list is written in [ ], not in ( )");
    if (token_ == Token::other && (text_[at_] == '*' || text_[at_] == '/'))
      return say(at_, "an expression needs quotation marks, as in \"${stride} * 2\"");
    if (token_ == Token::other && std::iscntrl(static_cast<unsigned char>(text_[at_])) != 0)
      return say(at_, "there is an invisible character here; remove it");
    if (token_ == Token::other)
      return say(at_, "the character '" + token_words() + "' has no meaning here");
  }

  void take_end() {
    if (at_top()) {
      if (inside().expects == Expects::value)
        say(at_,
            "the text ends before its first value; a file must contain an object, as in { \"t\": "
            "0.5 }");
      return;
    }
    if (doubtful_ && open_.size() == 2)
      return say(*doubtful_,
                 std::string("the text ends too early: a ") + closing(inside().bracket) +
                     " is missing. It probably belongs to the " + text_[*doubtful_] +
                     " of this line, because the next closing bracket is farther to the left");
    std::string words;
    for (size_t i = open_.size() - 1; i > 0; --i)
      words += (words.empty() ? "" : ", then ") + std::string(1, closing(open_[i].bracket)) +
               " for " + bracket_words(open_[i]);
    say(text_.size(), "the text ends too early; missing: " + words);
  }

  const std::string& text_;
  std::vector<Open> open_;
  std::optional<JsonSlip> slip_;
  Token token_ = Token::end;
  size_t at_ = 0, end_ = 0;  // beginning and end of the present token
  size_t before_ = 0;        // end of the previous token
  Token last_ = Token::end;  // the previous token, and its place
  size_t last_at_ = 0;
  std::optional<size_t> doubtful_;  // a bracket that perhaps closes the wrong opening bracket
  size_t name_at_ = 0, name_end_ = 0, value_begin_ = 0;
};

}  // namespace

std::optional<JsonSlip> find_json_slip(const std::string& text) { return SlipFinder(text).find(); }

}  // namespace ayumi
