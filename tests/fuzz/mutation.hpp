#pragma once
// Mutations that know the structure of an input: JSON and XML stay JSON and XML, and other text
// keeps its lines and numbers. The same seed gives the same mutant.

#include <cstdint>
#include <random>
#include <string>

namespace ayumi::fuzz {

using Random = std::minstd_rand;

/// One small change of a JSON text (comments get lost): a value is replaced, removed, doubled,
/// moved or nested, or a key is renamed to another one of the text. Returns "" if the text is not
/// JSON.
std::string mutate_json(const std::string& text, Random& random);

/// The same for an XML text: elements are removed, doubled, moved or nested; attributes are
/// removed, exchanged or changed. Text that is not well-formed is used as far as its tags can be
/// seen.
std::string mutate_xml(const std::string& text, Random& random);

/// Changes, removes, doubles or moves a number, word or line of a text.
std::string mutate_lines(const std::string& text, Random& random);

/// A file of an input changed by the mutation that fits its content.
std::string mutate_input(const std::string& input, Random& random);

}  // namespace ayumi::fuzz
