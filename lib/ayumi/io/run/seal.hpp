#pragma once
// The seal of a JSON file that Ayumi writes and reads again: run.json, and the results of `push`
// and `certify`. The last member of the object is the SHA-256 of the text before this member. It
// recognizes files that were edited or mixed up. It does not stop a person who computes it anew.

#include <string>

namespace ayumi {

/// Name of the last member of a sealed object.
inline constexpr const char* kSealKey = "contents_sha256";

/// The text of a JSON object with its seal. The "}" at the end of `object` must be on a line of its
/// own.
std::string sealed(const std::string& object);

/// Whether the text ends with its own seal, to the byte.
bool is_sealed(const std::string& text);

/// What a person must know about a text that is not sealed: whether its seal is missing or wrong.
/// Empty if the text is sealed.
std::string wrong_seal(const std::string& text);

}  // namespace ayumi
