#include "ayumi/io/run/seal.hpp"

#include "ayumi/base/error.hpp"
#include "ayumi/io/run/sha256.hpp"

namespace ayumi {

namespace {

std::string seal_begin() { return std::string(",\n  \"") + kSealKey + "\""; }

std::string seal_of(const std::string& text) {
  return seal_begin() + ": \"" + sha256(text) + "\"\n}\n";
}

}  // namespace

std::string sealed(const std::string& object) {
  const size_t end = object.rfind("\n}");
  require(end != std::string::npos, "only an object over several lines can be sealed");
  const std::string text = object.substr(0, end);
  return text + seal_of(text);
}

bool is_sealed(const std::string& text) {
  const size_t at = text.rfind(seal_begin());
  return at != std::string::npos && text.substr(at) == seal_of(text.substr(0, at));
}

std::string wrong_seal(const std::string& text) {
  if (is_sealed(text)) return "";
  const std::string key = std::string("\"") + kSealKey + "\"";
  if (text.find(key) == std::string::npos)
    return "the file has no " + key +
           ", so an older version of Ayumi wrote the file, or the file was changed";
  return "the file has changed since Ayumi wrote it (its SHA-256 differs from " + key + ")";
}

}  // namespace ayumi
