#pragma once
// The library in one include: everything that most programs need of ayumi::core and ayumi::io.
//
//   load_task      robot and pattern from files                          io/task_file.hpp
//   judge          is the pattern physically consistent?                 task/task.hpp
//   simulate       closed loop with scripted disturbances                task/task.hpp
//   make_safe      a joint table with ramp and hold, judged for a robot  limits/table_safety.hpp
//   write_table    the table as a file, written whole or not at all      io/table/table.hpp
//
// Repair (ayumi::repair), pictures (ayumi::render), reports (ayumi::report) and studies have
// headers of their own. Every function throws ayumi::Error; a negative verdict is a result, not an
// error.

#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "ayumi/base/error.hpp"
#include "ayumi/base/file.hpp"
#include "ayumi/base/text.hpp"
#include "ayumi/base/version.hpp"
#include "ayumi/io/formats/hoap.hpp"
#include "ayumi/io/pattern/pattern_file.hpp"
#include "ayumi/io/robot/robot_file.hpp"
#include "ayumi/io/table/table.hpp"
#include "ayumi/io/task_file.hpp"
#include "ayumi/plan/sample.hpp"
#include "ayumi/task/task.hpp"
