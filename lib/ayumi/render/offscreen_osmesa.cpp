// The library is only loaded for the first picture: with the compiler that it brings, it takes
// longer to load than all other libraries together.
#include "ayumi/base/error.hpp"
#include "ayumi/render/offscreen_context.hpp"

#ifdef AYUMI_OSMESA

#include <GL/osmesa.h>
#include <dlfcn.h>

namespace ayumi::offscreen {

namespace {

struct Library {
  decltype(&OSMesaCreateContextAttribs) create;
  decltype(&OSMesaDestroyContext) destroy;
  decltype(&OSMesaMakeCurrent) make_current;
  decltype(&OSMesaGetCurrentContext) current;
  decltype(&OSMesaGetProcAddress) function;
};

Library load() {
  void* const handle = dlopen(AYUMI_OSMESA, RTLD_LAZY | RTLD_LOCAL);
  const auto complain = [] {
    const char* const reason = dlerror();
    fail(ErrorCode::internal, std::string("off-screen rendering: ") + AYUMI_OSMESA +
                                  " cannot be loaded (" + (reason ? reason : "no reason given") +
                                  "); install OSMesa (libosmesa6)");
  };
  if (!handle) complain();
  const auto find = [&](auto& address, const char* name) {
    address = reinterpret_cast<std::remove_reference_t<decltype(address)>>(dlsym(handle, name));
    if (!address) complain();
  };
  Library library{};
  find(library.create, "OSMesaCreateContextAttribs");
  find(library.destroy, "OSMesaDestroyContext");
  find(library.make_current, "OSMesaMakeCurrent");
  find(library.current, "OSMesaGetCurrentContext");
  find(library.function, "OSMesaGetProcAddress");
  return library;
}

// The library stays loaded until the process ends.
const Library& library() {
  static const Library loaded = load();
  return loaded;
}

}  // namespace

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
  void* context = library().create(attributes, nullptr);
  if (!context)
    fail(ErrorCode::internal,
         "off-screen rendering: this OSMesa library gives "
         "no OpenGL 3.3 core context");
  return context;
}

void Osmesa::destroy(void* context) {
  if (library().current() == context) library().make_current(nullptr, nullptr, 0, 0, 0);
  library().destroy(static_cast<OSMesaContext>(context));
}

bool Osmesa::make_current(void* context, unsigned char* buffer) {
  return library().current() == context ||
         library().make_current(static_cast<OSMesaContext>(context), buffer, GL_UNSIGNED_BYTE, 16,
                                16);
}

OffscreenContext::Function Osmesa::function(const char* name) {
  return reinterpret_cast<OffscreenContext::Function>(library().function(name));
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
