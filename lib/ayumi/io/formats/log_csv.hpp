#pragma once
// A log as comma-separated text: one head row with names and units, then a row per tick. Numbers
// are the shortest text from which the same number is read back.

#include <string>

#include "ayumi/io/run/log_table.hpp"

namespace ayumi {

std::string log_csv(const LogTable& table);

}  // namespace ayumi
