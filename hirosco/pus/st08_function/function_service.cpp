// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st08_function/function_service.hpp"

#include <algorithm>
#include <array>

#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace {

using descriptor::Function;

constexpr std::size_t max_arguments = 255;   ///< ids are one octet

[[nodiscard]] std::string_view name_in(Octets field) noexcept {
  std::size_t length = 0;
  while (length < field.size() && field[length] != std::byte{}) ++length;
  // NUL is padding only: a name that goes on behind it is another name, which nobody has.
  for (std::size_t i = length; i < field.size(); ++i)
    if (field[i] != std::byte{}) return {};
  return {reinterpret_cast<const char*>(field.data()), length};
}

[[nodiscard]] CallFailure at_start(const FailureNotice& notice) noexcept { return {notice, Stage::Start}; }
[[nodiscard]] CallFailure bad_argument(std::size_t index, std::size_t id) noexcept {
  return at_start(instruction_failure(FailureCode::ValueNotAcceptable, index, static_cast<std::uint32_t>(id)));
}
[[nodiscard]] CallFailure bad_length() noexcept { return {FailureNotice{FailureCode::DataLength}, Stage::Acceptance}; }

struct Found {
  const Function* function{nullptr};
  std::uint16_t index{};
};
[[nodiscard]] Found find(std::span<const Function> functions, std::span<const Function> built_in,
                         std::string_view name) noexcept {
  if (name.empty()) return {};
  for (std::size_t i = 0; i < functions.size(); ++i)
    if (functions[i].name == name) return {&functions[i], static_cast<std::uint16_t>(i)};
  for (std::size_t i = 0; i < built_in.size(); ++i)
    if (built_in[i].name == name) return {&built_in[i], static_cast<std::uint16_t>(first_built_in_function + i)};
  return {};
}

/// The arguments of one call while they are taken from a telecommand.
class ArgumentTaker {
 public:
  ArgumentTaker(const Function& function, FunctionCall& call) noexcept : function_{function}, call_{call} {}

  /// A wrong length shows behind wrong values and comes first in the checks, so reading goes on after those.
  [[nodiscard]] std::optional<CallFailure> take(OctetReader& reader) {
    const std::size_t declared = function_.arguments.size();
    std::optional<CallFailure> first;
    const auto count = reader.get<std::uint8_t>();
    for (std::size_t index = 0; index < count; ++index) {
      const auto id = reader.get<std::uint8_t>();
      if (!reader.good()) return bad_length();
      // The width of an unknown argument is unknown too: nothing behind it can be read.
      if (id == 0 || id > declared) return first ? first : bad_argument(index, id);
      const Octets begin = reader.rest();
      const bool good = take_permitted(reader, function_.arguments[id - 1]) && taken_[id - 1].empty();
      taken_[id - 1] = begin.first(begin.size() - reader.remaining());
      if (!reader.good()) return bad_length();
      if (!good && !first) first = bad_argument(index, id);
    }
    if (!reader.exhausted()) return bad_length();
    return first ? first : put_in_order(count);
  }

 private:
  /// In declared order, the declared value where there is none.
  [[nodiscard]] std::optional<CallFailure> put_in_order(std::size_t count) {
    std::size_t at = 0;
    const auto put = [&](Octets value) {
      std::ranges::copy(value, call_.arguments.begin() + static_cast<std::ptrdiff_t>(at));
      at += value.size();
    };
    for (std::size_t i = 0; i < function_.arguments.size(); ++i) {
      if (!taken_[i].empty()) {
        put(taken_[i]);
        continue;
      }
      OctetWriter writer{MutableOctets{call_.arguments}.subspan(at)};
      if (!put_declared(writer, function_.arguments[i])) return bad_argument(count, i + 1);
      at += writer.written().size();
    }
    return std::nullopt;
  }

  /// As append_values() has it, without the heap; false: there is no declared value.
  [[nodiscard]] static bool put_declared(OctetWriter& writer, const Argument& argument) noexcept {
    if (!argument.fallback) return false;
    const bool wants_words = argument.field.type == Type::Text;
    if (const auto* words = std::get_if<std::string>(&*argument.fallback)) {
      if (!wants_words || !permits(argument, *words)) return false;
      writer.put(static_cast<std::uint16_t>(words->size())).put(std::as_bytes(std::span{*words}));
      return writer.good();
    }
    const Number& number = std::get<Number>(*argument.fallback);
    if (wants_words || !permits(argument, number)) return false;
    for (std::uint32_t i = 0; i < argument.field.count; ++i)
      if (!write_number(writer, argument.field.type, number)) return false;
    return writer.good();
  }

  const Function& function_;
  FunctionCall& call_;
  std::array<Octets, max_arguments> taken_{};  ///< by place; none is empty
};

[[nodiscard]] Function built_in_with(const char* name, const char* argument, double maximum, const char* description) {
  Function function;
  function.name = name;
  function.states = 0x03FF;
  function.description = description;
  Function::Argument only;
  only.field.name = argument;
  only.field.type = Type::Uint8;
  only.field.minimum = 0;
  only.field.maximum = maximum;
  function.arguments.push_back(only);
  return function;
}

}  // namespace

namespace st08 {
constexpr Part call_data[]{{.name = "FUNCTION", .form = Form::Text, .count = function_name_octets},
                           {.name = "ARGUMENTS", .form = Form::Arguments}};
constexpr RequestKind requests[]{{FunctionService::perform_function, "PERFORM", call_data}};
}  // namespace st08

const ServiceKind FunctionService::service_kind{
    .type = service_type, .name = "functions", .requests = st08::requests, .reports = {}};

std::vector<Function> common_functions() {
  return {built_in_with("SET_STATE", "STATE", 9, "Changes the state (0 Offline .. 9 Software-Deinit)"),
          built_in_with("CONFIGURE", "CONFIGURATION", 255, "Selects the configuration with this id")};
}

std::expected<FunctionCall, CallFailure> decode_call(std::span<const Function> functions, Octets application_data,
                                                     std::span<const Function> built_in) {
  if (application_data.size() < function_name_octets + 1) return std::unexpected{bad_length()};
  const Octets name = application_data.first(function_name_octets);
  const Found found = find(functions, built_in, name_in(name));
  if (found.function == nullptr)
    return std::unexpected{at_start(FailureNotice{FailureCode::UnknownIdentifier}.with(std::uint8_t{0}).with(name))};
  const Function& function = *found.function;
  if (octets_of(function.arguments) > descriptor::max_argument_octets || function.arguments.size() > max_arguments)
    return std::unexpected{at_start(FailureNotice{FailureCode::CapacityExceeded}.with(std::uint8_t{0}))};
  FunctionCall call;
  call.function = found.index;
  OctetReader reader{application_data.subspan(function_name_octets)};
  if (const auto failure = ArgumentTaker{function, call}.take(reader)) return std::unexpected{*failure};
  return call;
}

Result<> write_call(OctetWriter& writer, const Function& function, GivenValues values) noexcept {
  if (function.name.empty() || function.name.size() > function_name_octets)
    return fail(ErrorCode::InvalidArgument, "function name");
  writer.put(std::as_bytes(std::span{function.name}));
  writer.fill(function_name_octets - function.name.size(), std::byte{});
  writer.put(static_cast<std::uint8_t>(function.arguments.size()));
  return write_values(writer, function.arguments, values, Ids::One);
}

Result<std::vector<std::byte>> encode_call(const Function& function, GivenValues values) {
  std::array<std::byte, max_telecommand_octets> room;
  OctetWriter writer{room};
  HIROSCO_TRY(write_call(writer, function, values));
  HIROSCO_TRY_LET(const Octets data, all_written(writer));
  return std::vector<std::byte>(data.begin(), data.end());
}

Result<std::vector<std::byte>> encode_call(const Function& function, std::span<const double> values) {
  const std::vector<std::optional<Value>> given(values.begin(), values.end());
  return encode_call(function, GivenValues{given});
}

Result<std::vector<std::byte>> encode_call(const Function& function,
                                           std::span<const std::pair<std::string_view, Value>> named_values) {
  std::vector<std::optional<Value>> given(value_count(function));
  for (const auto& [name, value] : named_values) {
    std::size_t at = 0;
    std::size_t end = 0;
    for (const Argument& argument : function.arguments) {
      at = end;
      end += value_count(argument);
      if (argument.field.name == name) break;
      at = end;
    }
    if (at == end) return fail(ErrorCode::NotFound, "argument name");
    while (at < end && given[at]) ++at;
    if (at == end) return fail(ErrorCode::InvalidArgument, "argument given too often");
    given[at] = value;
  }
  return encode_call(function, GivenValues{given});
}

void FunctionService::handle(const TelecommandView& telecommand, const Request& request) {
  if (telecommand.subtype() != perform_function) return verification_.rejected(request, unknown_subtype(telecommand));
  const auto call = decode_call(functions_, telecommand.application_data(), built_in_);
  if (!call && call.error().stage == Stage::Acceptance) return verification_.rejected(request, call.error().notice);
  verification_.accepted(request);
  if (!call) return verification_.start_failed(request, call.error().notice);
  if (const auto submitted = executor_.submit(*call, request); !submitted)
    verification_.start_failed(request, submitted.error());
}

}  // namespace hirosco::pus
