#pragma once
// What --help prints: the path as one screen, and for each command its examples first.

#include <CLI/CLI.hpp>
#include <string>

namespace ayumi::app {

/// Examples are a subcommand's footer.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
};

}  // namespace ayumi::app
