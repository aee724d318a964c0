#include "mutation.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <vector>

#include "fuzz_target.hpp"

/// libFuzzer's own mutation of bytes. AFL++ has no such function and mutates bytes itself.
extern "C" __attribute__((weak)) size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t most);

namespace ayumi::fuzz {

namespace {

using Json = nlohmann::ordered_json;

size_t below(Random& random, size_t count) { return count ? random() % count : 0; }
bool chance(Random& random, size_t one_in) { return below(random, one_in) == 0; }

// Numbers at which readers make decisions.
const char* const kNumbers[] = {"0",
                                "-0",
                                "1",
                                "-1",
                                "2",
                                "1e-300",
                                "1e300",
                                "-1e300",
                                "5e-324",
                                "1e6",
                                "1000001",
                                "0.1",
                                "1e-9",
                                "255",
                                "256",
                                "2147483647",
                                "2147483648",
                                "-2147483649",
                                "4294967296",
                                "9223372036854775807",
                                "18446744073709551615",
                                "1e19",
                                "3.5",
                                "0.001",
                                "100000"};
const char* const kWords[] = {"",      "nan",   "inf",   "-inf", "../x",    "/dev/zero", "left",
                              "both",  "home",  "${a}",  "1/0",  "\x1b[2J", "\xff",      "a b",
                              "1 2 3", "0 0 0", "1e999", "true", "deg",     "t[s]"};

std::string any_number(Random& random) { return kNumbers[below(random, std::size(kNumbers))]; }
std::string any_word(Random& random) {
  if (chance(random, 20)) return std::string(1 + below(random, 5000), 'a');
  return kWords[below(random, std::size(kWords))];
}

Json any_value(Random& random) {
  switch (below(random, 8)) {
    case 0:
      return nullptr;
    case 1:
      return chance(random, 2);
    case 2:
      return Json::array();
    case 3:
      return Json::object();
    case 4:
      return any_word(random);
    case 5:
      return Json::array({0, 1, 2});
    default:
      return Json::parse(any_number(random), nullptr, false);
  }
}

double changed_number(double x, Random& random) {
  switch (below(random, 6)) {
    case 0:
      return -x;
    case 1:
      return x * (0.5 + static_cast<double>(below(random, 1000)) / 500);
    case 2:
      return x + 1;
    case 3:
      return x * 1000;
    case 4:
      return x / 1000;
    default:
      return std::floor(x);
  }
}

// Every value of a tree, containers first.
void collect(Json& value, std::vector<Json*>& all) {
  if (all.size() > 20'000) return;
  all.push_back(&value);
  if (value.is_structured())
    for (Json& child : value) collect(child, all);
}

void rename_key(Json& object, Random& random, const std::string& name) {
  const size_t which = below(random, object.size());
  Json renamed = Json::object();
  size_t i = 0;
  for (auto& [key, value] : object.items()) renamed[i++ == which ? name : key] = value;
  object = renamed;
}

void remove_child(Json& parent, Random& random) {
  const size_t which = below(random, parent.size());
  if (parent.is_array())
    parent.erase(which);
  else
    parent.erase(std::next(parent.begin(), static_cast<long>(which)));
}

std::string dumped(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string mutate_json(const std::string& text, Random& random) {
  Json root = Json::parse(text, nullptr, false, true);
  if (root.is_discarded()) return "";
  for (size_t changes = 1 + below(random, 3); changes > 0; --changes) {
    std::vector<Json*> all;
    collect(root, all);
    Json& value = *all[below(random, all.size())];
    const Json other = *all[below(random, all.size())];
    switch (below(random, 10)) {
      case 0:
        value = any_value(random);
        break;
      case 1:
        if (dumped(other).size() < 5000) value = other;
        break;
      case 2:
        if (value.is_structured() && !value.empty()) remove_child(value, random);
        break;
      case 3:
        if (value.is_array())
          for (size_t n = chance(random, 10) ? 200 : 1; n > 0; --n)
            value.push_back(value.empty() ? other : Json(value[below(random, value.size())]));
        else if (value.is_object())
          value[any_word(random)] = other;
        break;
      case 4:
        for (size_t depth = chance(random, 10) ? 300 : 1; depth > 0; --depth)
          value = Json::array({value});
        break;
      case 5:
        value = Json{{any_word(random), value}};
        break;
      case 6:
        if (value.is_object() && !value.empty()) {
          std::string name = any_word(random);
          if (other.is_object() && !other.empty())
            name = std::next(other.begin(), static_cast<long>(below(random, other.size()))).key();
          rename_key(value, random, name);
        }
        break;
      case 7:
        if (value.is_string()) value = mutate_lines(value.get<std::string>(), random);
        break;
      default:
        for (size_t tries = 0; tries < 20; ++tries) {
          Json& number = *all[below(random, all.size())];
          if (!number.is_number()) continue;
          const double changed = changed_number(number.get<double>(), random);
          number = chance(random, 3) ? Json::parse(any_number(random), nullptr, false)
                                     : Json(std::isfinite(changed) ? changed : 0.0);
          break;
        }
    }
  }
  return dumped(root);
}

namespace {

// A tag, or the text between two tags.
struct Token {
  std::string text;
  enum class Kind { text, open, close, single } kind = Kind::text;
};

std::vector<Token> tokens_of(const std::string& text) {
  std::vector<Token> tokens;
  for (size_t at = 0; at < text.size() && tokens.size() < 20'000;) {
    if (text[at] != '<') {
      const size_t end = std::min(text.find('<', at), text.size());
      tokens.push_back({text.substr(at, end - at)});
      at = end;
      continue;
    }
    const size_t end = std::min(text.find('>', at), text.size() - 1) + 1;
    Token token{text.substr(at, end - at), Token::Kind::open};
    if (token.text.size() > 1 && (token.text[1] == '?' || token.text[1] == '!'))
      token.kind = Token::Kind::text;
    else if (token.text.size() > 1 && token.text[1] == '/')
      token.kind = Token::Kind::close;
    else if (token.text.size() > 2 && token.text[token.text.size() - 2] == '/')
      token.kind = Token::Kind::single;
    tokens.push_back(token);
    at = end;
  }
  return tokens;
}

// The index after the end of the element that begins at `first`.
size_t end_of(const std::vector<Token>& tokens, size_t first) {
  size_t depth = 0;
  for (size_t i = first; i < tokens.size(); ++i) {
    if (tokens[i].kind == Token::Kind::open) ++depth;
    if (tokens[i].kind == Token::Kind::close && depth > 0) --depth;
    if (depth == 0) return i + 1;
  }
  return tokens.size();
}

struct Attribute {
  size_t begin = 0, end = 0;              // the attribute with its value and quotes
  size_t value_begin = 0, value_end = 0;  // the value without the quotes
};

std::vector<Attribute> attributes_of(const std::string& tag) {
  std::vector<Attribute> attributes;
  for (size_t at = tag.find('='); at != std::string::npos; at = tag.find('=', at + 1)) {
    const size_t quote = tag.find_first_of("\"'", at);
    if (quote == std::string::npos) break;
    const size_t end = tag.find(tag[quote], quote + 1);
    if (end == std::string::npos) break;
    const size_t blank = tag.find_last_of(" \t\n", at);
    attributes.push_back({blank == std::string::npos ? at : blank, end + 1, quote + 1, end});
    at = end;
  }
  return attributes;
}

void change_attribute(std::string& tag, const std::string& other_tag, Random& random) {
  const std::vector<Attribute> own = attributes_of(tag), others = attributes_of(other_tag);
  if (own.empty()) return;
  const Attribute a = own[below(random, own.size())];
  const std::string value = tag.substr(a.value_begin, a.value_end - a.value_begin);
  switch (below(random, 5)) {
    case 0:
      tag.erase(a.begin, a.end - a.begin);
      return;
    case 1:
      tag.insert(a.begin, tag.substr(a.begin, a.end - a.begin));
      return;
    case 2:
      if (!others.empty()) {
        const Attribute b = others[below(random, others.size())];
        tag.replace(a.value_begin, value.size(),
                    other_tag.substr(b.value_begin, b.value_end - b.value_begin));
      }
      return;
    case 3:
      tag.replace(a.value_begin, value.size(),
                  chance(random, 2) ? any_number(random) : any_word(random));
      return;
    default:
      tag.replace(a.value_begin, value.size(), mutate_lines(value, random));
  }
}

}  // namespace

std::string mutate_xml(const std::string& text, Random& random) {
  std::vector<Token> tokens = tokens_of(text);
  for (size_t changes = 1 + below(random, 3); changes > 0 && !tokens.empty(); --changes) {
    const size_t first = below(random, tokens.size()), end = end_of(tokens, first);
    const auto at = [&](size_t i) { return tokens.begin() + static_cast<long>(i); };
    const std::vector<Token> element(at(first), at(end));
    const size_t target = below(random, tokens.size());
    switch (below(random, 8)) {
      case 0:
        tokens.erase(at(first), at(end));
        break;
      case 1:
        if (element.size() < 500) tokens.insert(at(target), element.begin(), element.end());
        break;
      case 2:
        if (tokens[first].kind == Token::Kind::open)
          for (size_t n = chance(random, 10) ? 250 : 1; n > 0; --n) {
            const std::string name =
                tokens[first].text.substr(1, tokens[first].text.find_first_of(" >/\t\n") - 1);
            tokens.insert(at(first), {"<" + name + ">", Token::Kind::open});
            tokens.push_back({"</" + name + ">", Token::Kind::close});
          }
        break;
      case 3:
        if (tokens[first].kind == Token::Kind::text)
          tokens[first].text = mutate_lines(tokens[first].text, random);
        break;
      case 4:
        std::swap(tokens[first], tokens[target]);
        break;
      default: {
        Token& tag = tokens[first];
        if (tag.kind != Token::Kind::text) change_attribute(tag.text, tokens[target].text, random);
      }
    }
  }
  std::string all;
  for (const Token& token : tokens) all += token.text;
  return all;
}

namespace {

struct Span {
  size_t begin = 0, end = 0;
};

// Runs of characters that are in `set` (with `in`), or not in it.
std::vector<Span> spans(const std::string& text, const char* set, bool in) {
  std::vector<Span> all;
  for (size_t at = 0; at < text.size() && all.size() < 50'000;) {
    const size_t begin = in ? text.find_first_of(set, at) : text.find_first_not_of(set, at);
    if (begin == std::string::npos) break;
    const size_t end = std::min(
        in ? text.find_first_not_of(set, begin) : text.find_first_of(set, begin), text.size());
    all.push_back({begin, end});
    at = end;
  }
  return all;
}

}  // namespace

std::string mutate_lines(const std::string& text, Random& random) {
  std::string all = text;
  const size_t kind = below(random, 6);
  const std::vector<Span> lines = spans(text, "\n", false);
  const std::vector<Span> numbers = spans(text, "0123456789.+-eE", true);
  if (kind == 0 && !lines.empty()) {
    const Span line = lines[below(random, lines.size())];
    all.erase(line.begin, line.end - line.begin);
  } else if (kind == 1 && !lines.empty()) {
    const Span line = lines[below(random, lines.size())];
    std::string more = text.substr(line.begin, line.end - line.begin) + "\n";
    for (size_t n = chance(random, 10) ? 8 : 0; n > 0 && more.size() < 2000; --n) more += more;
    all.insert(lines[below(random, lines.size())].begin, more);
  } else if (kind <= 3 && !numbers.empty()) {
    const Span number = numbers[below(random, numbers.size())];
    all.replace(number.begin, number.end - number.begin,
                chance(random, 4) ? any_word(random) : any_number(random));
  } else if (kind == 4 && !text.empty()) {
    const char set[] = ",;\t \n#\"'[]{}<>()/\\=:-+.0a\xff";
    all[below(random, all.size())] = set[below(random, sizeof set - 1)];
  } else {
    all.insert(below(random, all.size() + 1),
               chance(random, 2) ? any_word(random) : any_number(random));
  }
  return all;
}

std::string mutate_input(const std::string& input, Random& random) {
  std::vector<Part> parts = parts_of(input);
  Part& part = parts[below(random, parts.size())];
  if (chance(random, 50) && parts.size() > 1) {
    std::swap(part.bytes, parts[below(random, parts.size())].bytes);
    return joined(parts);
  }
  const size_t begin = part.bytes.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const char first = begin == std::string::npos ? '\0' : part.bytes[begin];
  std::string mutant;
  if (first == '{' || first == '[') mutant = mutate_json(part.bytes, random);
  if (first == '<') mutant = mutate_xml(part.bytes, random);
  if (mutant.empty()) mutant = mutate_lines(part.bytes, random);
  part.bytes = mutant;
  return joined(parts);
}

}  // namespace ayumi::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t most, unsigned seed) {
  ayumi::fuzz::Random random(seed % 2147483646 + 1);
  // Bytes are mutated as well, because they can do what no structure allows, and libFuzzer has
  // learned from comparisons.
  if (random() % 2 == 0 && LLVMFuzzerMutate) return LLVMFuzzerMutate(data, size, most);
  const std::string mutant =
      ayumi::fuzz::mutate_input({reinterpret_cast<const char*>(data), size}, random);
  if (mutant.size() > most) return LLVMFuzzerMutate ? LLVMFuzzerMutate(data, size, most) : size;
  std::memcpy(data, mutant.data(), mutant.size());
  return mutant.size();
}
