#pragma once
// Mutation that knows the structure of an input: JSON and XML stay JSON and XML, other text keeps
// its lines and numbers. The same seed gives the same mutant.

#include <cstdint>
#include <random>
#include <string>

namespace ayumi::fuzz {

using Random = std::minstd_rand;

/// One small change of a JSON text (comments get lost): a value replaced, removed, doubled, moved,
/// nested, or a key renamed to another one of the text. "" where it is not JSON.
std::string mutate_json(const std::string& text, Random& random);

/// The same of an XML text: elements removed, doubled, moved, nested; attributes removed, exchanged
/// and changed. Text that is not well-formed is taken as far as its tags are seen.
std::string mutate_xml(const std::string& text, Random& random);

/// A number, word or line of a text changed, removed, doubled or moved.
std::string mutate_lines(const std::string& text, Random& random);

/// A file of an input changed by the mutation that fits its content.
std::string mutate_input(const std::string& input, Random& random);

}  // namespace ayumi::fuzz
