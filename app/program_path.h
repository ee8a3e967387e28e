#pragma once

#include <filesystem>

namespace lobe {

/// The folder this program's file is in, symbolic links resolved; empty where the system does not tell.
std::filesystem::path ProgramFolder();

}  // namespace lobe
