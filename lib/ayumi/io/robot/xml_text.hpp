#pragma once
// Reads XML from files that are not trusted, by TinyXML. Only files of io/robot include it.

#include <tinyxml.h>

#include <string>
#include <vector>

namespace ayumi {

/// Parses `bytes`; `kind` ("a URDF") is for messages. Throws Error(bad_file) with file and line for
/// a text that is not XML, that is nested more deeply than any robot's file, or that has an element
/// with more attributes than any robot's file.
void parse_xml(TiXmlDocument& document, const std::string& bytes, const std::string& file,
               const std::string& kind);

/// Throws Error(bad_file) "file:line: message" for the place of `at`.
[[noreturn]] void complain_xml(const std::string& file, const TiXmlElement* at,
                               const std::string& message);

/// The attribute of an element, or `other` if it is missing or there is no element.
std::string xml_attribute(const TiXmlElement* element, const char* name, const std::string& other);

/// A value of an attribute for a message: in one line, and cut off if it is long.
std::string shown_value(const std::string& value);

/// The `count` numbers in `text`, which is in the element `at`; a message begins with `place`.
/// Throws Error(bad_file) if a word is not a finite number, or if the number of words is not
/// `count`.
std::vector<double> xml_numbers(const std::string& file, const TiXmlElement* at,
                                const std::string& place, const std::string& text, int count);

}  // namespace ayumi
