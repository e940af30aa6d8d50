// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <fstream>

#include "hirosco/descriptor/read.hpp"
#include "hirosco/xml/reader.hpp"

namespace hirosco::descriptor {

FileSource file_system() {
  return [](const std::filesystem::path& file) -> std::optional<std::string> {
    // Regular files only: a pipe would block, a device never end.
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error) || error) return std::nullopt;
    std::ifstream stream{file, std::ios::binary};
    if (!stream) return std::nullopt;
    std::string octets(xml::max_document_octets + 1, '\0');
    stream.read(octets.data(), static_cast<std::streamsize>(octets.size()));
    if (stream.bad() || stream.gcount() > static_cast<std::streamsize>(xml::max_document_octets)) return std::nullopt;
    octets.resize(static_cast<std::size_t>(stream.gcount()));
    octets.shrink_to_fit();
    return octets;
  };
}

}  // namespace hirosco::descriptor
