// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st08_function/function_service.hpp"

#include <bitset>
#include <cmath>

#include "hirosco/parameter/number.hpp"
#include "hirosco/pus/st01_verification/instructions.hpp"

namespace hirosco::pus {
namespace {

using descriptor::Field;
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

[[nodiscard]] std::size_t value_count(const Function& function) noexcept {
  std::size_t count = 0;
  for (const auto& argument : function.arguments) count += argument.field.count;
  return count;
}

/// Doubles hold integers exactly up to 2^53 only.
[[nodiscard]] bool exact_in_a_double(Octets value, Type type) noexcept {
  constexpr std::int64_t limit = std::int64_t{1} << 53;
  OctetReader reader{value};
  if (type == Type::Uint64) return reader.get<std::uint64_t>() <= static_cast<std::uint64_t>(limit);
  if (type != Type::Int64) return true;
  const auto number = reader.get<std::int64_t>();
  return number >= -limit && number <= limit;
}

[[nodiscard]] bool in_range(const Field& field, double value) noexcept {
  return std::isfinite(value) && (!field.minimum || value >= *field.minimum) &&
         (!field.maximum || value <= *field.maximum);
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

/// The arguments of one call while they are read.
class ArgumentReader {
 public:
  ArgumentReader(const Function& function, FunctionCall& call) noexcept : function_{function}, call_{call} {
    call.argument_count = static_cast<std::uint8_t>(value_count(function));
  }

  /// A wrong length shows behind wrong values and comes first in the checks, so reading goes on after those.
  [[nodiscard]] std::optional<CallFailure> read(OctetReader& reader) noexcept {
    std::optional<CallFailure> first;
    const auto count = reader.get<std::uint8_t>();
    for (std::size_t index = 0; index < count; ++index) {
      const auto id = reader.get<std::uint8_t>();
      if (!reader.good()) return bad_length();
      // The width of an unknown argument is unknown too: nothing behind it can be read.
      if (id == 0 || id > function_.arguments.size()) return first ? first : bad_argument(index, id);
      const bool good = read_values(reader, id);
      if (!reader.good()) return bad_length();
      if (!good && !first) first = bad_argument(index, id);
    }
    if (!reader.exhausted()) return bad_length();
    return first ? first : fill_in_missing(count);
  }

 private:
  [[nodiscard]] bool read_values(OctetReader& reader, std::size_t id) noexcept {
    const Field& field = function_.arguments[id - 1].field;
    bool good = !seen_.test(id);
    seen_.set(id);
    for (std::size_t i = 0; i < field.count; ++i) {
      const Octets raw = reader.rest();
      const double value = get_number(reader, field.type);
      good = good && reader.good() && exact_in_a_double(raw, field.type) && in_range(field, value);
      if (good) call_.arguments[first_value(id) + i] = value;
    }
    return good;
  }

  [[nodiscard]] std::optional<CallFailure> fill_in_missing(std::size_t count) noexcept {
    for (std::size_t id = 1; id <= function_.arguments.size(); ++id) {
      if (seen_.test(id)) continue;
      const auto& argument = function_.arguments[id - 1];
      if (!argument.fallback) return bad_argument(count, id);
      for (std::size_t i = 0; i < argument.field.count; ++i) call_.arguments[first_value(id) + i] = *argument.fallback;
    }
    return std::nullopt;
  }

  [[nodiscard]] std::size_t first_value(std::size_t id) const noexcept {
    std::size_t at = 0;
    for (std::size_t before = 1; before < id; ++before) at += function_.arguments[before - 1].field.count;
    return at;
  }

  const Function& function_;
  FunctionCall& call_;
  std::bitset<max_arguments + 1> seen_;
};

[[nodiscard]] Result<> check_value(const Field& field, double value) noexcept {
  if (!std::isfinite(value)) return fail(ErrorCode::InvalidArgument, "argument is not a number");
  if (!in_range(field, value)) return fail(ErrorCode::OutOfRange, "argument outside its range");
  std::array<std::byte, 8> buffer;
  OctetWriter writer{buffer};
  put_number(writer, field.type, value);
  if (field.type == Type::Double) return ok();
  OctetReader reader{writer.written()};
  const double back = get_number(reader, field.type);
  if (field.type == Type::Float)
    return std::isfinite(back) ? ok() : fail(ErrorCode::OutOfRange, "argument exceeds FLOAT");
  if (!exact_in_a_double(writer.written(), field.type)) return fail(ErrorCode::OutOfRange, "argument above 2^53");
  if (back == value) return ok();
  if (std::trunc(value) != value) return fail(ErrorCode::InvalidArgument, "fraction for an integer argument");
  return fail(ErrorCode::OutOfRange, "argument exceeds its type");
}

void append(std::vector<std::byte>& data, Octets octets) { data.insert(data.end(), octets.begin(), octets.end()); }

enum class WithIds : std::uint8_t { No, Yes };

[[nodiscard]] Result<> append_arguments(std::vector<std::byte>& data, const Function& function,
                                        std::span<const std::optional<double>> values, WithIds with_ids) {
  std::size_t next = 0;
  for (std::size_t id = 1; id <= function.arguments.size(); ++id) {
    const auto& argument = function.arguments[id - 1];
    if (with_ids == WithIds::Yes) data.push_back(static_cast<std::byte>(id));
    for (std::size_t i = 0; i < argument.field.count; ++i, ++next) {
      const std::optional<double> value = next < values.size() && values[next] ? values[next] : argument.fallback;
      if (!value) return fail(ErrorCode::InvalidArgument, "argument missing", static_cast<std::int64_t>(id));
      HIROSCO_TRY(check_value(argument.field, *value));
      std::array<std::byte, 8> buffer;
      OctetWriter writer{buffer};
      put_number(writer, argument.field.type, *value);
      append(data, writer.written());
    }
  }
  return ok();
}

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
  if (value_count(function) > max_function_arguments || function.arguments.size() > max_arguments)
    return std::unexpected{at_start(FailureNotice{FailureCode::CapacityExceeded}.with(std::uint8_t{0}))};
  FunctionCall call;
  call.function = found.index;
  OctetReader reader{application_data.subspan(function_name_octets)};
  if (const auto failure = ArgumentReader{function, call}.read(reader)) return std::unexpected{*failure};
  return call;
}

Result<std::vector<std::byte>> encode_call(const Function& function, std::span<const std::optional<double>> values) {
  if (function.name.empty() || function.name.size() > function_name_octets)
    return fail(ErrorCode::InvalidArgument, "function name");
  if (values.size() > value_count(function)) return fail(ErrorCode::InvalidArgument, "too many arguments");
  std::vector<std::byte> data(function_name_octets + 1);
  OctetWriter{data}.put(std::as_bytes(std::span{function.name}));
  data.back() = static_cast<std::byte>(function.arguments.size());
  HIROSCO_TRY(append_arguments(data, function, values, WithIds::Yes));
  return data;
}

Result<std::vector<std::byte>> encode_arguments_in_order(const Function& request,
                                                         std::span<const std::optional<double>> values) {
  if (values.size() > value_count(request)) return fail(ErrorCode::InvalidArgument, "too many arguments");
  std::vector<std::byte> data;
  HIROSCO_TRY(append_arguments(data, request, values, WithIds::No));
  return data;
}

Result<std::vector<std::byte>> encode_call(const Function& function, std::span<const double> values) {
  const std::vector<std::optional<double>> given(values.begin(), values.end());
  return encode_call(function, std::span<const std::optional<double>>{given});
}

Result<std::vector<std::byte>> encode_call(const Function& function,
                                           std::span<const std::pair<std::string_view, double>> named_values) {
  std::vector<std::optional<double>> given(value_count(function));
  for (const auto& [name, value] : named_values) {
    std::size_t at = 0;
    std::size_t end = 0;
    for (const auto& argument : function.arguments) {
      at = end;
      end += argument.field.count;
      if (argument.field.name == name) break;
      at = end;
    }
    if (at == end) return fail(ErrorCode::NotFound, "argument name");
    while (at < end && given[at]) ++at;
    if (at == end) return fail(ErrorCode::InvalidArgument, "argument given too often");
    given[at] = value;
  }
  return encode_call(function, std::span<const std::optional<double>>{given});
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
