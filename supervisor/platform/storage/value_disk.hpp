// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <vector>

#include "hirosco/utilities/octets.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::supervisor {

/// Seam: the steps by which a small file is replaced. Between any two of them the computer may lose its power; what that leaves is what
/// the tests of ValueCopies are about.  Realtime: blocks.
class ValueDisk {
 public:
  using Path = std::filesystem::path;
  virtual ~ValueDisk() = default;
  /// All of it. NotFound: there is no such file; OutOfRange: it is longer than `most` octets.
  [[nodiscard]] virtual Result<std::vector<std::byte>> read(const Path& file, std::size_t most) = 0;
  /// A file of these octets, in a folder that is made if need be; sync() only puts them on the disk.
  [[nodiscard]] virtual Result<> create(const Path& file, Octets octets) = 0;
  [[nodiscard]] virtual Result<> sync(const Path& file) = 0;
  /// `to` is what `from` was, or what it was itself: never anything between.
  [[nodiscard]] virtual Result<> rename(const Path& from, const Path& to) = 0;
  /// The names in it are on the disk.
  [[nodiscard]] virtual Result<> sync_folder(const Path& folder) = 0;
};

/// Of the operating system.
class SystemValueDisk final : public ValueDisk {
 public:
  Result<std::vector<std::byte>> read(const Path& file, std::size_t most) override;
  Result<> create(const Path& file, Octets octets) override;
  Result<> sync(const Path& file) override;
  Result<> rename(const Path& from, const Path& to) override;
  Result<> sync_folder(const Path& folder) override;
};

/// One that nothing outlives: of a simulation, which is to have no past.
class MemoryValueDisk : public ValueDisk {
 public:
  Result<std::vector<std::byte>> read(const Path& file, std::size_t most) override;
  Result<> create(const Path& file, Octets octets) override;
  Result<> sync(const Path&) override { return ok(); }
  Result<> rename(const Path& from, const Path& to) override;
  Result<> sync_folder(const Path&) override { return ok(); }

 protected:
  std::map<Path, std::vector<std::byte>> files_;
};

}  // namespace hirosco::supervisor
