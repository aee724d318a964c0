#include "ayumi/base/error.hpp"

namespace ayumi {

std::string text_of(const SourcePlace& place) {
  std::string words = place.file;
  for (const long number : {place.line, place.column})
    if (number > 0) words += ":" + std::to_string(number);
  if (!place.inside.empty()) words += (words.empty() ? "" : ": ") + place.inside;
  return words;
}

SourcePlace operator+(SourcePlace place, const std::string& inside) {
  place.inside += inside;
  return place;
}

void fail(ErrorCode code, const std::string& message) { throw Error(code, message); }

void fail(ErrorCode code, const SourcePlace& place, const std::string& what) {
  const std::string where = text_of(place);
  throw Error(code, where.empty() ? what : where + ": " + what, place, words_at(place, what));
}

std::string words_at(const SourcePlace& place, const std::string& what) {
  return place.inside.empty() ? what : place.inside + ": " + what;
}

void fail_unknown_name(SourcePlace place, const std::string& what) {
  place.unknown_name = true;
  fail(ErrorCode::bad_pattern, place, what);
}

}  // namespace ayumi
