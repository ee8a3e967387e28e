#pragma once

#include <string>

namespace lobe {

/// Asks the desktop to show an address, if there is a desktop: on Linux xdg-open, with DISPLAY or
/// WAYLAND_DISPLAY set; on macOS open. Waits for nothing and is silent when it fails.
void OpenBrowser(const std::string& address);

}  // namespace lobe
