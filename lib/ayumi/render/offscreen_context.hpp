#pragma once
// An OpenGL context without window, display or graphics card: by OSMesa or by
// surfaceless EGL, whichever this build found.

#include <string>
#include <vector>

namespace ayumi {

enum class Offscreen { automatic, osmesa, egl };

/// The ways this build has, the one that `automatic` takes first.
std::vector<Offscreen> offscreen_ways();

/// RAII around a context of OpenGL 3.3 core or newer. To be used by one thread
/// at a time.
class OffscreenContext {
 public:
  using Function = void (*)();

  /// Throws Error(internal) saying what is missing when there is no such
  /// context to be had.
  explicit OffscreenContext(Offscreen way = Offscreen::automatic);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes the calling thread's OpenGL calls go here.
  void make_current();
  /// Address of an OpenGL function; throws Error(internal) when the driver
  /// lacks it.
  Function function(const char* name) const;

 private:
  Offscreen way_;
  void* context_ = nullptr;
  void* display_ = nullptr;            ///< of EGL
  unsigned char buffer_[4 * 16 * 16];  ///< of OSMesa; drawing goes to framebuffer objects
};

namespace offscreen {

/// What one way of making contexts has to do; each in a source of its own.
struct Osmesa {
  static void* create();
  static void destroy(void* context);
  static bool make_current(void* context, unsigned char* buffer);
  static OffscreenContext::Function function(const char* name);
};
struct Egl {
  static void* create(void*& display);
  static void destroy(void* display, void* context);
  static bool make_current(void* display, void* context);
  static OffscreenContext::Function function(const char* name);
};

}  // namespace offscreen
}  // namespace ayumi
