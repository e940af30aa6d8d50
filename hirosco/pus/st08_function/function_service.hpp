// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "hirosco/descriptor/model/subsystem.hpp"
#include "hirosco/pus/service/arguments.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/utilities/result.hpp"

namespace hirosco::pus {

inline constexpr std::size_t function_name_octets = 16;
inline constexpr std::uint16_t first_built_in_function = 0xFF00;

/// A decoded and checked call: trivially copyable, travels to the cycle. Values stand in declared order whatever the order
/// on the wire; ArgumentReader reads them.
struct FunctionCall {
  std::uint16_t function{};  ///< index into SubsystemDescriptor::functions, or first_built_in_function + index
  ArgumentData arguments{};
};

/// Which stage of a request a failure belongs to.
enum class Stage : std::uint8_t { Acceptance, Start };
struct CallFailure {
  FailureNotice notice;
  Stage stage{Stage::Acceptance};
};

/// The functions that every subsystem has (decision 10): SET_STATE(state u8) and CONFIGURE(configuration u8).
enum BuiltInFunction : std::uint16_t { set_state_function = 0xFF00, configure_function = 0xFF01 };
[[nodiscard]] std::vector<descriptor::Function> common_functions();

/// Decodes the application data of TC[8,1] (ECSS-E-ST-70-41C 8.8.2; README.md): name of 16 octets, N x (argument id u8, value). A value is its
/// numbers in order, or length u16 and octets of text. Arguments come in any order, each at most once, ids from 1; absent
/// ones take their declared value. Acceptance: code 8. Start: 0x0101 with index 0 and the 16 octets of the name; 0x0105
/// with index and argument id for an argument that is unknown, doubled, missing, out of range, not a finite number, no value
/// of its enumeration, longer than declared or no UTF-8 (a missing one has the index N); 0x0104 for a function whose
/// arguments take more than max_argument_octets. The functions of `built_in` count from first_built_in_function.  Pure.
[[nodiscard]] std::expected<FunctionCall, CallFailure> decode_call(std::span<const descriptor::Function> functions,
                                                                   Octets application_data,
                                                                   std::span<const descriptor::Function> built_in = {});

/// Application data of TC[8,1], for whoever calls a function. InvalidArgument: an argument without value, too many values,
/// and what write_value() says; OutOfRange: against the declared range, length or type.  Realtime: bounded.
[[nodiscard]] Result<> write_call(OctetWriter& writer, const descriptor::Function& function,
                                  GivenValues values) noexcept;
/// The same, of its own; OutOfRange also of what no telecommand holds.
[[nodiscard]] Result<std::vector<std::byte>> encode_call(const descriptor::Function& function, GivenValues values);
[[nodiscard]] Result<std::vector<std::byte>> encode_call(const descriptor::Function& function,
                                                         std::span<const double> values);
/// By name; an element of an array is named twice in order. NotFound: the function has no such argument.
[[nodiscard]] Result<std::vector<std::byte>> encode_call(
    const descriptor::Function& function, std::span<const std::pair<std::string_view, Value>> named_values);

/// Takes calls to where they are executed. Whoever implements it reports start, progress and completion of what it took.
struct FunctionExecutor {
  virtual ~FunctionExecutor() = default;
  /// Queues the call for the cycle; a notice becomes a failed start.
  [[nodiscard]] virtual std::expected<void, FailureNotice> submit(const FunctionCall& call, const Request& request) = 0;
};

/// ST[08]: accepts calls and submits them.  Thread: the service loop.
class FunctionService final : public Service {
 public:
  static constexpr std::uint8_t service_type = 8;
  enum Subtype : std::uint8_t { perform_function = 1 };

  /// `functions` outlives the service.
  FunctionService(std::span<const descriptor::Function> functions, std::vector<descriptor::Function> built_in,
                  FunctionExecutor& executor, Verification& verification)
      : functions_{functions}, built_in_{std::move(built_in)}, executor_{executor}, verification_{verification} {}
  static const ServiceKind service_kind;
  [[nodiscard]] const ServiceKind& kind() const noexcept override { return service_kind; }
  void handle(const TelecommandView& telecommand, const Request& request) override;

 private:
  std::span<const descriptor::Function> functions_;
  std::vector<descriptor::Function> built_in_;
  FunctionExecutor& executor_;
  Verification& verification_;
};

}  // namespace hirosco::pus
