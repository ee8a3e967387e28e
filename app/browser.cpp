#include "app/browser.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

namespace lobe {
namespace {

#ifdef __APPLE__
constexpr const char* kOpener = "open";
bool HasDesktop() { return true; }
#else
constexpr const char* kOpener = "xdg-open";
bool IsSet(const char* variable) {
  const char* value = std::getenv(variable);
  return value && *value;
}
bool HasDesktop() { return IsSet("DISPLAY") || IsSet("WAYLAND_DISPLAY"); }
#endif

}  // namespace

void OpenBrowser(const std::string& address) {
  if (!HasDesktop()) return;
  const pid_t child = fork();
  if (child > 0) waitpid(child, nullptr, 0);
  if (child != 0) return;
  // A grandchild in a session of its own: nobody's zombie, and Ctrl-C here does not close the browser.
  if (setsid() < 0 || fork() != 0) _exit(0);
  const int nothing = open("/dev/null", O_RDWR);
  if (nothing >= 0) {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) dup2(nothing, stream);
  }
  execlp(kOpener, kOpener, address.c_str(), static_cast<char*>(nullptr));
  _exit(127);
}

}  // namespace lobe
