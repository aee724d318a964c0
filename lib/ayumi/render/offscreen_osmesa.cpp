#include "ayumi/base/error.hpp"
#include "ayumi/render/offscreen_context.hpp"

#ifdef AYUMI_HAS_OSMESA

#include <GL/osmesa.h>

namespace ayumi::offscreen {

void* Osmesa::create() {
  const int attributes[] = {OSMESA_FORMAT,
                            OSMESA_RGBA,
                            OSMESA_DEPTH_BITS,
                            0,
                            OSMESA_PROFILE,
                            OSMESA_CORE_PROFILE,
                            OSMESA_CONTEXT_MAJOR_VERSION,
                            3,
                            OSMESA_CONTEXT_MINOR_VERSION,
                            3,
                            0};
  void* context = OSMesaCreateContextAttribs(attributes, nullptr);
  if (!context)
    fail(ErrorCode::internal,
         "off-screen rendering: this OSMesa library gives "
         "no OpenGL 3.3 core context");
  return context;
}

void Osmesa::destroy(void* context) {
  if (OSMesaGetCurrentContext() == context) OSMesaMakeCurrent(nullptr, nullptr, 0, 0, 0);
  OSMesaDestroyContext(static_cast<OSMesaContext>(context));
}

bool Osmesa::make_current(void* context, unsigned char* buffer) {
  return OSMesaGetCurrentContext() == context ||
         OSMesaMakeCurrent(static_cast<OSMesaContext>(context), buffer, GL_UNSIGNED_BYTE, 16, 16);
}

OffscreenContext::Function Osmesa::function(const char* name) {
  return reinterpret_cast<OffscreenContext::Function>(OSMesaGetProcAddress(name));
}

}  // namespace ayumi::offscreen

#else

namespace ayumi::offscreen {

void* Osmesa::create() { fail(ErrorCode::internal, "built without OSMesa"); }
void Osmesa::destroy(void*) {}
bool Osmesa::make_current(void*, unsigned char*) { return false; }
OffscreenContext::Function Osmesa::function(const char*) { return nullptr; }

}  // namespace ayumi::offscreen

#endif
