#pragma once
// The file of a pattern, to which both an editor and the pages write. No change is lost.

#include <filesystem>
#include <string>
#include <vector>

namespace ayumi::app {

/// Replaces the file by `text` if its bytes are still `expected`; otherwise returns false and does
/// not change the file. The file keeps its permissions. Throws Error(bad_file) as write_file()
/// does.
bool replace_text(const std::filesystem::path& file, const std::string& expected,
                  const std::string& text);

/// All texts that the file has had since the start, whoever wrote them. One of them is the present
/// text.
class TextHistory {
 public:
  /// Adds a text that was read: it is the present one, or a new one after it. A new text ends the
  /// list of steps that can be redone.
  void add(const std::string& text);
  /// Makes the text one step back (-1) or forward (1) the present one.
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
