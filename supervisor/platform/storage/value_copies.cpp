// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/platform/storage/value_copies.hpp"

#include "hirosco/descriptor/model/subsystem.hpp"

namespace hirosco::supervisor {
namespace {

/// The count in front of the values has one octet more.
constexpr std::size_t most_octets = value_copy_overhead + 1 + descriptor::max_persistent_octets;

[[nodiscard]] std::expected<ValueCopy, CopyFault> read_one(ValueDisk& disk, const std::filesystem::path& path) {
  const auto octets = disk.read(path, most_octets);
  if (octets) return read_copy(*octets);
  switch (octets.error().code) {
    case ErrorCode::NotFound: return std::unexpected{CopyFault::Missing};
    case ErrorCode::OutOfRange: return std::unexpected{CopyFault::Damaged};
    default: return std::unexpected{CopyFault::Unreadable};
  }
}

}  // namespace

std::filesystem::path ValueCopies::path(std::size_t copy) const {
  auto path = file_;
  return path += copy == 0 ? ".1" : ".2";
}

TwoCopies ValueCopies::read() {
  TwoCopies both{read_one(disk_, path(0)), read_one(disk_, path(1))};
  whole_ = both[0] && (!both[1] || both[0]->sequence > both[1]->sequence) ? 0 : 1;
  return both;
}

Result<> ValueCopies::write(const ValueCopy& copy) {
  const std::vector<std::byte> octets = write_copy(copy);
  const std::size_t last = whole_, first = 1 - whole_;
  HIROSCO_TRY(replace(first, octets));
  whole_ = first;
  return replace(last, octets);
}

Result<> ValueCopies::replace(std::size_t copy, Octets octets) {
  const auto target = path(copy);
  auto beside = target;
  beside += ".new";
  HIROSCO_TRY(disk_.create(beside, octets));
  HIROSCO_TRY(disk_.sync(beside));
  HIROSCO_TRY(disk_.rename(beside, target));
  return disk_.sync_folder(target.parent_path());
}

}  // namespace hirosco::supervisor
