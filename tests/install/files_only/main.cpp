// Loads and checks every pattern of the installed data, by the components core and io alone.

#include <ayumi/ayumi.hpp>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path data = argv[1];
  int inconsistent = 0;
  for (const auto& entry : std::filesystem::directory_iterator(data / "patterns")) {
    const ayumi::Task task = ayumi::load_task(entry.path(), {.robots = {{data / "robots"}}});
    if (!ayumi::judge(task).good()) ++inconsistent;
  }
  return inconsistent;
}
