#pragma once
// An OpenGL context without window, display or graphics card.

namespace ayumi {

/// RAII around an OSMesa context of OpenGL 3.3 core or newer. To be used by one thread at a time.
class OffscreenContext {
 public:
  /// Throws Error(internal) saying what is missing when there is no such context to be had.
  OffscreenContext();
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes the calling thread's OpenGL calls go here.
  void make_current();
  /// Address of an OpenGL function; throws Error(internal) when the driver lacks it.
  static void (*function(const char* name))();

 private:
  void* context_ = nullptr;
  unsigned char buffer_[4 * 16 * 16];  ///< drawing goes to framebuffer objects, not here
};

}  // namespace ayumi
