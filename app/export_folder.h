#pragma once

#include <atomic>
#include <string>

#include "app/site.h"

namespace lobe {

/// Throws InputError if WriteExportFolder(`path`) would: its parent folder missing or read-only; a file of
/// that name; a folder that holds anything but an earlier export, by what its own view.json lists. Asked
/// before long work.
void CheckExportFolder(const std::string& path);

/// Writes `site` as the folder `path`: into a passing name beside it, flushed, renamed, so that it is absent,
/// an earlier export, or complete. A symbolic link is kept and its target replaced. Throws InputError, also
/// when `interrupted` is set meanwhile; nothing is left then.
void WriteExportFolder(const std::string& path, const SiteFiles& site, const std::atomic<bool>& interrupted);

}  // namespace lobe
