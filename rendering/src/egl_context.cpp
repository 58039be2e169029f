// SPDX-License-Identifier: BSD-3-Clause
#include "egl_context.h"
#include <EGL/eglext.h>
#include <array>
#include <cstdlib>
#include <fresco/core/require.h>
#include <fstream>
#include <new>
#include <stdexcept>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
namespace fresco::rendering {
namespace {
[[noreturn]] void fail(const std::string& what)
{
  throw std::runtime_error(concat("no picture without EGL (packages libegl1, libgl1-mesa-dri): ", what,
                                  ", EGL error 0x", std::hex, eglGetError()));
}

bool hasExtension(const char* list, const std::string& name)
{
  return list && (" " + std::string(list) + " ").find(" " + name + " ") != std::string::npos;
}

EGLDisplay surfacelessDisplay(PFNEGLGETPLATFORMDISPLAYEXTPROC get_display)
{
  const EGLDisplay display = get_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) ? display : EGL_NO_DISPLAY;
}

/// First graphics device that starts: the way of drivers that have no surfaceless platform.
EGLDisplay deviceDisplay(PFNEGLGETPLATFORMDISPLAYEXTPROC get_display)
{
  const auto query = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(eglGetProcAddress("eglQueryDevicesEXT"));
  std::array<EGLDeviceEXT, 16> devices{};
  EGLint count = 0;
  if (!query || !query(devices.size(), devices.data(), &count))
    return EGL_NO_DISPLAY;
  for (EGLint i = 0; i < count; ++i) {
    const EGLDisplay display = get_display(EGL_PLATFORM_DEVICE_EXT, devices[i], nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr))
      return display;
  }
  return EGL_NO_DISPLAY;
}

/// Where the process's memory is limited, Mesa's software renderer may fail to start its threads and then waits for
/// them for ever, and it does not check what it allocates: it does without threads, and is not asked at all where
/// hardly anything is left. @throws std::bad_alloc
void checkMemoryLimit()
{
  constexpr std::size_t needed = std::size_t{768}
                                 << 20; // libraries, compiler, buffers of a picture, with room to spare
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return;
  setenv("LP_NUM_THREADS", "0", 0);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  if (pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + needed > limit.rlim_cur)
    throw std::bad_alloc();
}

EGLDisplay openDisplay()
{
  checkMemoryLimit();
  setenv("EGL_LOG_LEVEL", "fatal", 0); // Mesa writes its warnings to stderr; failures are reported by exceptions here
  const char* extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto get_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  EGLDisplay display = EGL_NO_DISPLAY;
  if (get_display && hasExtension(extensions, "EGL_MESA_platform_surfaceless"))
    display = surfacelessDisplay(get_display);
  if (get_display && display == EGL_NO_DISPLAY && hasExtension(extensions, "EGL_EXT_platform_device"))
    display = deviceDisplay(get_display);
  if (display == EGL_NO_DISPLAY)
    fail("neither the surfaceless nor the device platform works");
  if (!eglBindAPI(EGL_OPENGL_API))
    fail("it offers no desktop OpenGL");
  return display;
}
} // namespace

EglContext::EglContext()
{
  static const EGLDisplay shared_display = openDisplay();
  display_ = shared_display;
  eglBindAPI(EGL_OPENGL_API); // a setting of the calling thread
  const EGLint wanted[][2] = {{EGL_SURFACE_TYPE, EGL_PBUFFER_BIT},
                              {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT},
                              {EGL_RED_SIZE, 8},
                              {EGL_GREEN_SIZE, 8},
                              {EGL_BLUE_SIZE, 8},
                              {EGL_NONE}};
  EGLConfig config = nullptr;
  EGLint count = 0;
  if (!eglChooseConfig(display_, *wanted, &config, 1, &count) || count < 1)
    fail("no configuration with 8 bits per colour");
  const EGLint version[][2] = {{EGL_CONTEXT_MAJOR_VERSION, 3},
                               {EGL_CONTEXT_MINOR_VERSION, 2},
                               {EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT},
                               {EGL_NONE}};
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, *version);
  if (context_ == EGL_NO_CONTEXT)
    fail("no OpenGL 3.2 context");
  const EGLint size[] = {EGL_WIDTH, 8, EGL_HEIGHT, 8, EGL_NONE};
  surface_ = eglCreatePbufferSurface(display_, config, size);
  if (surface_ == EGL_NO_SURFACE || !eglMakeCurrent(display_, surface_, surface_, context_)) {
    eglDestroyContext(display_, context_);
    fail("no drawing surface in memory");
  }
}

EglContext::~EglContext()
{
  if (isCurrent())
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  eglDestroySurface(display_, surface_);
  eglDestroyContext(display_, context_);
}

void EglContext::makeCurrent()
{
  if (!isCurrent() && !eglMakeCurrent(display_, surface_, surface_, context_))
    fail("the context cannot be made current");
}
} // namespace fresco::rendering
