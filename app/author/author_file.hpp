#pragma once
// The file of a pattern that an editor and pages write in turn: no one's change is lost.

#include <filesystem>
#include <string>
#include <vector>

namespace ayumi::app {

/// Puts `text` in the place of the file if its bytes are still `expected`; false, and the file as
/// it is, where they are not. The file keeps its permissions. Throws Error(bad_file) as
/// write_file() does.
bool replace_text(const std::filesystem::path& file, const std::string& expected,
                  const std::string& text);

/// All texts that the file has had since the start, whoever wrote them; one of them is the present
/// one.
class TextHistory {
 public:
  /// A text that was read: the present one, or a new one behind it. What could be redone is gone
  /// then.
  void add(const std::string& text);
  /// The present text is that of a step back, or forward.
  void step(int by) { at_ += by; }

  const std::string& present() const { return texts_[static_cast<size_t>(at_)]; }
  const std::string& near(int by) const { return texts_[static_cast<size_t>(at_ + by)]; }
  int undo_steps() const { return at_; }
  int redo_steps() const { return static_cast<int>(texts_.size()) - 1 - at_; }

 private:
  std::vector<std::string> texts_;
  int at_ = -1;
};

}  // namespace ayumi::app
