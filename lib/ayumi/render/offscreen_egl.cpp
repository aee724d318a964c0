#include "ayumi/base/error.hpp"
#include "ayumi/render/offscreen_context.hpp"

#ifdef AYUMI_HAS_EGL

#include <EGL/egl.h>
#include <EGL/eglext.h>

namespace ayumi::offscreen {

namespace {

[[noreturn]] void complain(const std::string& what) {
  fail(ErrorCode::internal, "off-screen rendering: " + what +
                                "; install Mesa's EGL (libegl-mesa0), or build with OSMesa");
}

/// Mesa's display without any surface. It is the same for every context of the process.
EGLDisplay surfaceless_display() {
  const auto get = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
      eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!get) complain("this EGL library knows no platform displays");
  EGLDisplay display =
      get(EGL_PLATFORM_SURFACELESS_MESA, reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
  if (display == EGL_NO_DISPLAY || !eglInitialize(display, nullptr, nullptr))
    complain("EGL has no surfaceless display");
  return display;
}

}  // namespace

void* Egl::create(void*& display) {
  display = surfaceless_display();
  const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0, EGL_NONE};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglBindAPI(EGL_OPENGL_API) || !eglChooseConfig(display, wanted, &config, 1, &count) ||
      !count)
    complain("EGL has no OpenGL");
  const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                               3,
                               EGL_CONTEXT_MINOR_VERSION,
                               3,
                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                               EGL_NONE};
  const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
  if (context == EGL_NO_CONTEXT) complain("EGL gives no OpenGL 3.3 core context");
  return context;
}

void Egl::destroy(void* display, void* context) {
  if (eglGetCurrentContext() == context)
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroyContext(display, context);  // the display is shared and stays
}

bool Egl::make_current(void* display, void* context) {
  // The API is chosen per thread.
  return eglGetCurrentContext() == context ||
         (eglBindAPI(EGL_OPENGL_API) &&
          eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context));
}

OffscreenContext::Function Egl::function(const char* name) { return eglGetProcAddress(name); }

}  // namespace ayumi::offscreen

#else

namespace ayumi::offscreen {

void* Egl::create(void*&) { fail(ErrorCode::internal, "built without EGL"); }
void Egl::destroy(void*, void*) {}
bool Egl::make_current(void*, void*) { return false; }
OffscreenContext::Function Egl::function(const char*) { return nullptr; }

}  // namespace ayumi::offscreen

#endif
