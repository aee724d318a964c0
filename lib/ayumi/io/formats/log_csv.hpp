#pragma once
// A log as comma-separated text: one head row with names and units, then one row for each tick.
// Numbers are the shortest texts that give the same number again.

#include <string>

#include "ayumi/io/run/log_table.hpp"

namespace ayumi {

std::string log_csv(const LogTable& table);

}  // namespace ayumi
