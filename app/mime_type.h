#pragma once

#include <string>

namespace lobe {

/// The media type of a file of a web site by its ending; "application/octet-stream" if it is not known.
std::string MimeType(const std::string& name);

}  // namespace lobe
