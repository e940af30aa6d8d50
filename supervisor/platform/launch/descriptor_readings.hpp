// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "hirosco/descriptor/read/read.hpp"

namespace hirosco::supervisor {

/// What the disk says of a descriptor now.
struct DescriptorReading {
  std::shared_ptr<const std::string> text;  ///< null: it cannot be read
  descriptor::Reading<descriptor::Mission> mission;  ///< the whole, judged with it
};

/// Reads a file of a mission that flies, whose other files are as they were (docs/adr/0095). One at a time. Thread: the supervisor's.
class DescriptorReadings {
 public:
  virtual ~DescriptorReadings() = default;
  /// Unavailable: an earlier one has not ended.
  virtual Result<> begin(const descriptor::Mission& flown, const std::filesystem::path& file) = 0;
  /// Empty: not yet. Once for each begin().
  [[nodiscard]] virtual std::optional<DescriptorReading> outcome() = 0;
};

/// The reading itself.  Realtime: blocks, allocates. Thread: any.
[[nodiscard]] DescriptorReading read_now(const descriptor::Mission& flown, const std::filesystem::path& file,
                                         const descriptor::FileSource& source);

/// At once: on virtual time.
class DirectReadings final : public DescriptorReadings {
 public:
  explicit DirectReadings(descriptor::FileSource source) : source_{std::move(source)} {}
  Result<> begin(const descriptor::Mission& flown, const std::filesystem::path& file) override {
    newest_ = read_now(flown, file, source_);
    return ok();
  }
  [[nodiscard]] std::optional<DescriptorReading> outcome() override { return std::exchange(newest_, std::nullopt); }

 private:
  descriptor::FileSource source_;
  std::optional<DescriptorReading> newest_;
};

/// By a thread of ordinary priority: a disk that hangs holds nobody up.
class ThreadedReadings final : public DescriptorReadings {
 public:
  Result<> begin(const descriptor::Mission& flown, const std::filesystem::path& file) override;
  [[nodiscard]] std::optional<DescriptorReading> outcome() override;

 private:
  std::future<DescriptorReading> reading_;
};

}  // namespace hirosco::supervisor
