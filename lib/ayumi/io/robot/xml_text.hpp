#pragma once
// XML from files that are not trusted, by TinyXML. Included by io/*.cpp only.

#include <tinyxml.h>

#include <string>
#include <vector>

namespace ayumi {

/// Parses `bytes`; `kind` ("a URDF") is for messages. Throws Error(bad_file) with file and line for
/// what is not XML, nests deeper than any robot, or has an element with more attributes than any.
void parse_xml(TiXmlDocument& document, const std::string& bytes, const std::string& file,
               const std::string& kind);

/// Throws Error(bad_file) "file:line: message" for the place of `at`.
[[noreturn]] void complain_xml(const std::string& file, const TiXmlElement* at,
                               const std::string& message);

/// The attribute of an element, else `other`; also where there is no element.
std::string xml_attribute(const TiXmlElement* element, const char* name, const std::string& other);

/// The `count` numbers in `text`, which stands in `at`; `place` begins the message. Throws
/// Error(bad_file) for words that are no finite numbers, and for more or fewer of them.
std::vector<double> xml_numbers(const std::string& file, const TiXmlElement* at,
                                const std::string& place, const std::string& text, int count);

}  // namespace ayumi
