#pragma once
// An OpenGL context without window, display or graphics card, by OSMesa or by surfaceless EGL,
// whichever was found when the library was built.

#include <string>
#include <vector>

namespace ayumi {

enum class Offscreen { automatic, osmesa, egl };

/// The ways of making a context that this build has. `automatic` takes the first one.
std::vector<Offscreen> offscreen_ways();

/// Owns a context of OpenGL 3.3 core or newer. Only one thread may use it at a time.
class OffscreenContext {
 public:
  using Function = void (*)();

  /// Throws Error(internal) that says what is missing if no such context can be made.
  explicit OffscreenContext(Offscreen way = Offscreen::automatic);
  ~OffscreenContext();
  OffscreenContext(const OffscreenContext&) = delete;
  OffscreenContext& operator=(const OffscreenContext&) = delete;

  /// Makes this the context of the calling thread's OpenGL calls.
  void make_current();
  /// The address of an OpenGL function. Throws Error(internal) if the driver lacks it.
  Function function(const char* name) const;

 private:
  Offscreen way_;
  void* context_ = nullptr;
  void* display_ = nullptr;            ///< display of EGL
  unsigned char buffer_[4 * 16 * 16];  ///< buffer of OSMesa; drawing goes to framebuffer objects
};

namespace offscreen {

/// The functions of each way of making contexts; each way has a source of its own.
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
