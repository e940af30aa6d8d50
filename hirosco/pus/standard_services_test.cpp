// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/standard_services.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <set>

#include "hirosco/pus/packet/cuc.hpp"
#include "hirosco/pus/st01_verification/verification.hpp"
#include "hirosco/pus/st03_housekeeping/housekeeping_service.hpp"
#include "hirosco/pus/st05_event/event_service.hpp"
#include "hirosco/pus/st08_function/function_service.hpp"
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"
#include "hirosco/pus/st130_descriptor/descriptor_service.hpp"
#include "hirosco/pus/st20_parameter/parameter_service.hpp"
#include "hirosco/pus/testing/played_self_test.hpp"
#include "hirosco/pus/testing/recording_sink.hpp"

/// What a service says of itself is what it takes.
namespace hirosco::pus {
namespace {

using testing::Bytes;

void append(Bytes& data, const Part& part) {
  switch (part.form) {
    case Form::Number:
      // A link whose kind is 1 has no depth, and memory of its own.
      for (std::size_t i = 0; i < octets_of(part.type) * part.count; ++i)
        data.push_back(i % octets_of(part.type) == octets_of(part.type) - 1 && part.name != "DEPTH" &&
                               part.name != "MADE"
                           ? std::byte{1}
                           : std::byte{});
      break;
    case Form::Text:
      data.push_back(std::byte{'A'});
      data.resize(data.size() + part.count - 1);
      break;
    case Form::Word: data.insert(data.end(), {std::byte{1}, std::byte{'A'}}); break;
    case Form::Time: data.resize(data.size() + cuc_octets); break;
    case Form::List:
      data.push_back(std::byte{1});
      for (const Part& one : part.repeated()) append(data, one);
      break;
    case Form::Arguments: data.push_back(std::byte{}); break;
    case Form::Value:
    case Form::Rest: break;
  }
}

/// The shortest data of a shape whose lists have one entry each.
Bytes example_of(Shape shape) {
  Bytes data;
  for (const Part& part : shape) append(data, part);
  return data;
}

struct Nobody final : FunctionExecutor, ParameterAccess, DescriptorOwner {
  std::optional<FailureNotice> judge(std::size_t, const MemoryHandle&) override { return std::nullopt; }
  std::optional<FailureNotice> take() override { return std::nullopt; }
  std::expected<void, FailureNotice> submit(const FunctionCall&, const Request&) override { return {}; }
  std::expected<std::size_t, ErrorCode> read(std::uint32_t, MutableOctets) override { return 0; }
  std::size_t size_of(std::uint32_t) override { return 0; }
  std::expected<void, FailureCode> check_write(std::uint32_t, Octets) override { return {}; }
  std::expected<void, FailureCode> submit_write(std::span<const Write>, const Request&) override { return {}; }
};

/// What a service of a row alone is made with.
struct PlayedHome final : ServiceHome {
  PlayedHome(const descriptor::SubsystemDescriptor& subsystem, Verification& verification, TelemetrySink& sink)
      : subsystem_{subsystem}, verification_{verification}, sink_{sink} {}
  const descriptor::SubsystemDescriptor& descriptor() const noexcept override { return subsystem_; }
  descriptor::State state() const noexcept override { return descriptor::State::PreOperational; }
  Verification& verification() noexcept override { return verification_; }
  TelemetrySink& telemetry() noexcept override { return sink_; }
  SelfTest& self_test() noexcept override { return self_test_; }
  FailureNotice refusal(FailureCode code, const Error&) const override { return FailureNotice{code}; }

 private:
  const descriptor::SubsystemDescriptor& subsystem_;
  Verification& verification_;
  TelemetrySink& sink_;
  testing::PlayedSelfTest self_test_;
};

class Table : public ::testing::Test {
 protected:
  Table() {
    for (const ServiceKind* kind : standard_services())
      if (kind->make != nullptr) services_.push_back(made_.emplace_back(kind->make(home_)).get());
  }

  /// The stage and code of the first report: "1.1", "1.2 8".
  std::string answer(Service& service, std::uint8_t subtype, const Bytes& data) {
    sink_.reports.clear();
    testing::send(service, subtype, Octets{data});
    if (sink_.reports.empty()) return "nothing";
    const auto& first = sink_.reports.front();
    std::string text = "1." + std::to_string(first.subtype);
    if (first.subtype == 2) {
      OctetReader reader{first.data};
      static_cast<void>(reader.get<std::uint32_t>());
      text += " " + std::to_string(reader.get<std::uint16_t>());
    }
    return text;
  }
  static constexpr const char* wrong_length = "1.2 8";

  testing::RecordingSink sink_;
  Verification verification_{sink_};
  descriptor::SubsystemDescriptor subsystem_;
  HousekeepingSampler sampler_;
  Nobody nobody_;
  HousekeepingService housekeeping_{subsystem_, sampler_, verification_, sink_};
  EventService events_{subsystem_.events, verification_, sink_};
  FunctionService functions_{subsystem_.functions, {}, nobody_, verification_};
  ParameterService parameters_{nobody_, verification_, sink_};
  DescriptorService descriptor_{verification_, nobody_};
  PlayedHome home_{subsystem_, verification_, sink_};
  std::vector<std::unique_ptr<Service>> made_;
  std::vector<Service*> services_{&housekeeping_, &events_, &functions_, &parameters_, &descriptor_};
};

TEST_F(Table, HasAnObjectToBeTriedForEachServiceThatASubsystemHas) {
  // Reports only (ST[01]), the links of a process and the supervisor's own are tried where they are made.
  const std::set<std::uint8_t> elsewhere{1, 128, 129};
  std::set<std::uint8_t> tried;
  for (const Service* service : services_) tried.insert(service->kind().type);
  for (const ServiceKind* kind : standard_services())
    EXPECT_TRUE(tried.contains(kind->type) != elsewhere.contains(kind->type)) << int{kind->type};
}

TEST_F(Table, TakesDataOfTheShapeThatItDeclaresAndNoneThatIsAnOctetShort) {
  std::size_t seen = 0;
  for (Service* service : services_)
    for (const RequestKind& request : service->kind().requests) {
      SCOPED_TRACE(request.name);
      Bytes data = example_of(request.data);
      EXPECT_NE(answer(*service, request.subtype, data), wrong_length);
      if (data.empty()) data.push_back(std::byte{1});
      else data.pop_back();
      EXPECT_EQ(answer(*service, request.subtype, data), wrong_length);
      ++seen;
    }
  EXPECT_GE(seen, 20U);
}

TEST_F(Table, HasEverySubtypeThatAServiceTakes) {
  for (Service* service : services_)
    for (unsigned subtype = 0; subtype < 256; ++subtype) {
      const auto id = static_cast<std::uint8_t>(subtype);
      const bool unknown = answer(*service, id, {}) == "1.2 7";
      EXPECT_EQ(unknown, service->kind().request(id) == nullptr) << service->kind().name << " " << subtype;
    }
}

TEST_F(Table, DescribesTheHandshakeThatIsRead) {
  const auto data = [](std::uint8_t subtype) { return example_of(st128::service_kind.request(subtype)->data); };
  const auto reported = [](std::uint8_t subtype) { return example_of(st128::service_kind.report(subtype)->data); };
  EXPECT_TRUE(st128::read_offer_request(data(st128::request_offer)));
  EXPECT_TRUE(st128::read_terms_request(data(st128::negotiate_terms)));
  EXPECT_TRUE(st128::read_attach_request(data(st128::attach)));
  EXPECT_TRUE(st128::read_reach_request(data(st128::reach)));
  EXPECT_TRUE(st128::read_attached(reported(st128::attached)));
  EXPECT_TRUE(st128::read_offer(reported(st128::offer)));
  EXPECT_TRUE(st128::read_agreement(reported(st128::agreement)));
  EXPECT_TRUE(st128::read_refusal(reported(st128::refusal)));
}

bool has_no_end(Shape shape) {
  return !shape.empty() && (shape.back().form == Form::Rest || shape.back().form == Form::Value ||
                            (shape.back().form == Form::List && has_no_end(shape.back().repeated())));
}

/// What holds every report of every test to its shape (testing/report_shape.hpp) sees an octet too few or too many.
TEST(StandardServices, HaveReportsOfWhichNoOctetMayLackOrBeTooMany) {
  std::size_t held = 0;
  for (const ServiceKind* service : standard_services())
    for (const ReportKind& report : service->reports) {
      SCOPED_TRACE(report.name);
      const auto unlike = [&](const Bytes& data) {
        return testing::unlike_its_shape(service->type, report.subtype, Octets{data});
      };
      Bytes data = example_of(report.data);
      EXPECT_EQ(unlike(data), "");
      data.push_back(std::byte{});
      EXPECT_EQ(unlike(data).empty(), has_no_end(report.data));
      data.pop_back();
      if (data.empty()) continue;
      data.pop_back();
      EXPECT_NE(unlike(data), "");
      ++held;
    }
  EXPECT_GE(held, 25U);
  EXPECT_NE(testing::unlike_its_shape(20, 9, {}), "");
  EXPECT_EQ(testing::unlike_its_shape(first_custom_service, 9, {}), "");
}

TEST(StandardServices, HaveValuesAsLongAsTheirParametersSay) {
  const Bytes data = testing::from_hex(
      "02"
      "00010001"
      "aabb"
      "00010002"
      "cc");
  const auto unlike = [&](std::size_t second) {
    return testing::unlike_its_shape(20, 2, Octets{data}, [&](std::uint32_t id) {
      return std::optional{id == 0x00010001 ? std::size_t{2} : second};
    });
  };
  EXPECT_EQ(unlike(1), "");
  EXPECT_NE(unlike(2), "");
  EXPECT_NE(unlike(0), "");
}

TEST(StandardServices, HaveAWordForEachValueThatHasWords) {
  Bytes data = example_of(standard_service(17)->report(129)->data);
  EXPECT_EQ(testing::unlike_its_shape(17, 129, Octets{data}), "");
  data[0] = std::byte{5};
  EXPECT_EQ(testing::unlike_its_shape(17, 129, Octets{data}),
            "TM[17,129] is not of its shape: OUTCOME has no word for 5");
}

/// As docs/services.md shows them.
std::string table_of_services() {
  std::string table = "| service | requests | reports | who may ask |\n|---|---|---|---|\n";
  const auto names = [](const auto& kinds) {
    std::string text;
    for (const auto& kind : kinds)
      text += (text.empty() ? "" : ", ") + std::to_string(kind.subtype) + " " + std::string{kind.name};
    return text.empty() ? std::string{"none"} : text;
  };
  const auto may = [](Needs needs) -> std::string {
    switch (needs) {
      case Needs::Nothing: return "as mode and state permit";
      case Needs::Essential: return "everybody, always";
      case Needs::SupervisorAsks: return "the supervisor";
      case Needs::SupervisorAnswers: return "everybody, always; the supervisor answers";
    }
    return "";
  };
  const auto asks = [&](const ServiceKind& service) {
    if (service.requests.empty()) return std::string{"nobody"};
    std::string text = may(service.needs), others;
    for (const auto& request : service.requests)
      if (const Needs needs = service.needs_of(request.subtype); needs != service.needs)
        others += (others.empty() ? "" : ", ") + std::to_string(request.subtype) + ": " + may(needs);
    return others.empty() ? text : text + "; " + others;
  };
  for (const ServiceKind* service : standard_services())
    table += "| ST[" + std::to_string(service->type) + "] " + std::string{service->name} + " | " +
             names(service->requests) + " | " + names(service->reports) + " | " + asks(*service) + " |\n";
  return table;
}

TEST(StandardServices, AreTheTableInTheDocuments) {
  std::ifstream file{std::string{HIROSCO_SOURCE_DIR} + "/docs/services.md"};
  const std::string text{std::istreambuf_iterator<char>{file}, {}};
  EXPECT_NE(text.find(table_of_services()), std::string::npos) << "docs/services.md wants:\n" << table_of_services();
}

TEST(StandardServices, HaveTypesAndSubtypesOfTheirOwn) {
  std::set<int> types;
  for (const ServiceKind* service : standard_services()) {
    EXPECT_TRUE(types.insert(service->type).second) << service->name;
    EXPECT_LT(service->type, first_custom_service);
    std::set<int> subtypes;
    for (const auto& request : service->requests) EXPECT_TRUE(subtypes.insert(request.subtype).second) << request.name;
    for (const auto& report : service->reports) EXPECT_TRUE(subtypes.insert(report.subtype).second) << report.name;
    EXPECT_EQ(standard_service(service->type), service);
  }
  EXPECT_EQ(standard_service(99), nullptr);
}

TEST(StandardServices, HaveAmongThemThoseThatADescriptorMayLeaveOut) {
  for (const auto& named : descriptor::standard_services_by_name) {
    const ServiceKind* const kind = standard_service(named.type);
    ASSERT_NE(kind, nullptr) << named.name;
    EXPECT_EQ(named.name, (named.type < 10 ? "ST0" : "ST") + std::to_string(named.type));
    // What nobody asks a subsystem for is not left out by it, nor what has to pass in every mode.
    EXPECT_FALSE(kind->requests.empty()) << named.name;
    EXPECT_EQ(kind->needs, Needs::Nothing) << named.name;
  }
}

/// Which of them stay in the service loop is written where descriptors are read, below this library.
TEST(StandardServices, AreWhatADescriptorIsToldOfThoseThatStayInTheServiceLoop) {
  std::set<std::string> names;
  for (const ServiceKind* kind : standard_services())
    names.insert((kind->type < 10 ? "ST0" : "ST") + std::to_string(kind->type));
  for (const auto& stays : descriptor::stays_in_service_loop)
    EXPECT_TRUE(names.contains(std::string{stays.name})) << stays.name;
}

}  // namespace
}  // namespace hirosco::pus
