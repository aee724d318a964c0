#pragma once
// The "format" of JSON documents that people give to a command, such as "ayumi.pattern/1".

#include <string>

#include "ayumi/io/json/json_reader.hpp"

namespace ayumi {

/// Complains unless the document has this format. If it is a document of Ayumi that another command
/// reads, the message says what it is and names this command.
void require_format(const JsonNode& root, const std::string& format);

}  // namespace ayumi
