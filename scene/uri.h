#pragma once

#include <string>

namespace lobe {

/// %XX as the byte it stands for, RFC 3986 section 2.1; what is no such triple stays as it is.
std::string PercentDecoded(const std::string& uri);

/// The file a relative URI of the document at `document_path` means: beside it.
std::string FileOfUri(const std::string& document_path, const std::string& uri);

/// Of a path, in lower case, with its dot; "" if there is none.
std::string Extension(const std::string& path);

}  // namespace lobe
