// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <fstream>

#include "hirosco/descriptor/read/read.hpp"
#include "hirosco/utilities/os/installation.hpp"
#include "hirosco/xml/reader.hpp"

namespace hirosco::descriptor {
namespace {

/// Regular files only: a pipe would block, a device never end.
Result<> expect_regular(const std::filesystem::path& file) {
  std::error_code error;
  switch (std::filesystem::status(file, error).type()) {
    case std::filesystem::file_type::regular: return ok();
    case std::filesystem::file_type::directory: return fail(ErrorCode::InvalidArgument, "is a folder");
    case std::filesystem::file_type::fifo: return fail(ErrorCode::InvalidArgument, "is a pipe (FIFO)");
    case std::filesystem::file_type::socket: return fail(ErrorCode::InvalidArgument, "is a socket");
    case std::filesystem::file_type::character:
    case std::filesystem::file_type::block: return fail(ErrorCode::InvalidArgument, "is a device");
    case std::filesystem::file_type::not_found: return fail(ErrorCode::NotFound, "does not exist");
    default: break;
  }
  if (error == std::errc::too_many_symbolic_link_levels)
    return fail(ErrorCode::InvalidArgument, "is a symbolic link that leads in a circle");
  return fail(ErrorCode::SystemFailure, "cannot be reached", error.value());
}

/// What comes with HIROSCO is where that is installed, whatever the mission's folder.
std::filesystem::path place_of(const std::filesystem::path& file) {
  const std::string& name = file.native();
  return name.starts_with(shipped_prefix) ? find_shipped(name.substr(shipped_prefix.size())) : file;
}

}  // namespace

FileSource file_system() {
  return [](const std::filesystem::path& named) -> Result<std::string> {
    const std::filesystem::path file = place_of(named);
    HIROSCO_TRY(expect_regular(file));
    std::ifstream stream{file, std::ios::binary};
    if (!stream) return fail(ErrorCode::NotPermitted, "may not be read: its permissions forbid it");
    // Part by part: memory for the largest file there may be costs each process milliseconds of its start.
    std::string octets;
    for (std::array<char, 1 << 16> part; stream && octets.size() <= xml::max_document_octets;) {
      stream.read(part.data(), part.size());
      octets.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    }
    if (stream.bad()) return fail(ErrorCode::SystemFailure, "cannot be read to its end");
    if (octets.size() > xml::max_document_octets) return fail(ErrorCode::ResourceExhausted, "is larger than 4 MiB");
    return octets;
  };
}

}  // namespace hirosco::descriptor
