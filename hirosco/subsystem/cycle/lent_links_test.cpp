// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "hirosco/subsystem/testing/inside.hpp"

/// A camera lends its images to other subsystems: handshake by ST[128], cycle, age limit, death of the producer. The test is
/// the supervisor between them.
namespace hirosco::images {
namespace {

namespace st128 = pus::st128;
using st128::Role;
using ::testing::ElementsAre;
using testing::Rig;

constexpr std::size_t pixels = 1U << 20;
struct Image {
  std::uint64_t number;
  std::uint16_t width;
  std::uint16_t height;
  std::array<std::uint8_t, pixels> pixel;
};

constexpr auto fields_of_image =
    R"(<Field name="NUMBER" type="UINT64"/><Field name="WIDTH" type="UINT16"/><Field name="HEIGHT" type="UINT16"/>
       <Field name="PIXEL" type="UINT8" count="1048576"/>)";

std::string camera_descriptor(std::string_view fields = fields_of_image) {
  return R"(<Subsystem name="CAMERA" id="20"><Configuration name="C" id="1" sampling_us="1000"><RealTimeLinkService>
    <Provides name="IMAGE" kind="loaned">)" +
         std::string{fields} + "</Provides></RealTimeLinkService></Configuration></Subsystem>";
}
std::string viewer_descriptor(std::string_view fields = fields_of_image) {
  return R"(<Subsystem name="VIEWER" id="21"><Configuration name="C" id="1" sampling_us="1000"><RealTimeLinkService>
    <Requires name="VIEW" kind="loaned" byte_order="native" age="40">)" +
         std::string{fields} + "</Requires></RealTimeLinkService></Configuration></Subsystem>";
}

/// Makes an image where the test tells it to.
struct Camera final : Subsystem {
  LoanOutput<Image> image;
  std::uint64_t next{0};  ///< number of the image to make in the next cycle; 0 = none
  bool half{false};  ///< it is not ready in that cycle
  bool fails{false};
  Image* place{nullptr};  ///< lent in the last cycle

 protected:
  Result<Step> software_init() override {
    lend_link("IMAGE", image);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return make(); }
  Result<> safe_operational(const Cycle&) noexcept override { return make(); }
  Result<> operational(const Cycle&) noexcept override { return make(); }

 private:
  Result<> make() noexcept {
    place = image.lend();
    if (place != nullptr && next != 0) {
      place->number = next;
      place->width = place->height = 1024;
      place->pixel.fill(static_cast<std::uint8_t>(next));
      if (!half) image.publish();
      next = 0;
    }
    return fails ? fail(ErrorCode::Internal, "planted") : ok();
  }
};

struct Viewer final : Subsystem {
  LoanInput<Image> view;
  const Image* seen{nullptr};  ///< in the last cycle
  std::uint64_t number{0};  ///< of the last one that was whole
  std::size_t wrong{0};  ///< pixels of it

 protected:
  Result<Step> software_init() override {
    require_link("VIEW", view);
    return done;
  }
  Result<> pre_operational(const Cycle&) noexcept override { return look(); }
  Result<> safe_operational(const Cycle&) noexcept override { return look(); }
  Result<> operational(const Cycle&) noexcept override { return look(); }

 private:
  Result<> look() noexcept {
    seen = view.look();
    if (seen == nullptr) return ok();
    const std::uint64_t found = seen->number;
    const auto bad = static_cast<std::size_t>(std::ranges::count_if(
        seen->pixel, [&](std::uint8_t each) { return each != static_cast<std::uint8_t>(found); }));
    if (!view.whole()) return ok();
    number = found;
    wrong = bad;
    return ok();
  }
};

struct LentImages : ::testing::Test {
  HeapMemory memory;
  Camera camera;
  std::unique_ptr<Rig> camera_rig = std::make_unique<Rig>(camera, camera_descriptor());
  Viewer viewer, other;
  Rig viewer_rig{viewer, viewer_descriptor()};
  Rig other_rig{other, viewer_descriptor()};
  std::array<std::byte, max_packet_octets> buffer{};

  void SetUp() override {
    for (Rig* rig : {camera_rig.get(), &viewer_rig, &other_rig}) rig->bring_to(State::PreOperational);
  }
  Octets first(const Result<std::size_t>& written) { return Octets{buffer}.first(written.value()); }
  static Octets said(const Rig& rig, std::uint8_t subtype) {
    Octets last;
    for (const auto& report : rig.telemetry)
      if (report.service == st128::service_type && report.subtype == subtype) last = report.data;
    return last;
  }
  /// The supervisor's part of the handshake.
  st128::Agreement agree(Rig& consumer, std::uint8_t link) {
    consumer.send(128, st128::request_offer, first(st128::write_offer_request(buffer, {link, "VIEW"})));
    consumer.settle();
    const auto offer = st128::read_offer(said(consumer, st128::offer)).value();
    camera_rig->send(128, st128::negotiate_terms,
                     first(st128::write_terms_request(buffer, {link, "IMAGE", offer.offer})));
    camera_rig->settle();
    return st128::read_agreement(said(*camera_rig, st128::agreement)).value().agreement;
  }
  std::string attach(Rig& rig, const st128::AttachRequest& request, const MemoryHandle& shared) {
    const auto sent = rig.send(128, st128::attach, first(st128::write_attach_request(buffer, request)), shared);
    rig.settle(2);
    return rig.outcome(sent);
  }
  void couple(Rig& consumer, std::uint8_t link) {
    const auto agreement = agree(consumer, link);
    const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
    ASSERT_NE(mechanism, nullptr);
    const auto shared = mechanism
                            ->establish(memory, {.epoch = 1,
                                                 .payload_octets = agreement.payload_octets(),
                                                 .layout_hash = agreement.layout_hash(),
                                                 .period = agreement.producer_period})
                            .value();
    EXPECT_EQ(attach(*camera_rig, {link, Role::Producer, 1, "IMAGE", agreement}, shared), "1 3 7");
    EXPECT_EQ(attach(consumer, {link, Role::Consumer, 1, "VIEW", agreement}, shared), "1 3 7");
  }
  /// A link into the memory of those before it; the first one's is made.
  void couple_into(MemoryHandle& shared, Rig& consumer, std::uint8_t link, std::uint32_t epoch = 1) {
    const auto agreement = agree(consumer, link);
    const auto* mechanism = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
    const bool first_of_all = !shared;
    if (first_of_all) shared = mechanism->establish(memory, agreement.layout(1)).value();
    st128::AttachRequest request{.link = link,
                                 .role = Role::Producer,
                                 .epoch = first_of_all ? 1 : epoch + 1,
                                 .set = "IMAGE",
                                 .agreement = agreement,
                                 .made = first_of_all ? 0U : 1U};
    ASSERT_EQ(attach(*camera_rig, request, shared), "1 3 7");
    request.role = Role::Consumer;
    request.set = "VIEW";
    ASSERT_EQ(attach(consumer, request, shared), "1 3 7");
  }
  void make(std::uint64_t number) {
    camera.next = number;
    camera_rig->cycle();
  }
  void operate() {
    couple(viewer_rig, 1);
    make(1);
    for (const State state : {State::SafeOperational, State::Operational})
      ASSERT_EQ(viewer_rig.set_state_now(state), "1 3 7");
    make(2);
    viewer_rig.cycle();
    ASSERT_TRUE(viewer.view.valid());
    ASSERT_EQ(viewer_rig.inhibited(), 0u);
  }
};

TEST_F(LentImages, AreAgreedOnWithTheLayoutThatCppGivesThem) {
  const auto agreement = agree(viewer_rig, 1);
  EXPECT_EQ(agreement.kind, LinkKind::Loaned);
  EXPECT_EQ(agreement.payload_octets(), sizeof(Image));
  EXPECT_EQ(agreement.fields.back(), (st128::OfferedField{"PIXEL", Type::Uint8, pixels}));
}

TEST_F(LentImages, AreLookedAtWhereTheyWereMade) {
  EXPECT_EQ(camera.place, nullptr) << "no link, no place";
  couple(viewer_rig, 1);
  viewer_rig.cycle();
  EXPECT_EQ(viewer.seen, nullptr) << "no image yet";
  EXPECT_FALSE(viewer.view.valid());
  for (std::uint64_t number = 1; number <= 9; ++number) {
    make(number);
    const Image* made = camera.place;
    viewer_rig.cycle();
    EXPECT_EQ(viewer.seen, made);
    EXPECT_EQ(viewer.number, number);
    EXPECT_EQ(viewer.wrong, 0u);
    EXPECT_TRUE(viewer.view.valid());
    EXPECT_EQ(viewer_rig.vital.judged[0].load(), link_valid);
    EXPECT_EQ(viewer.view.count(), number);
    EXPECT_EQ(viewer.view.age_cycles(), 0u);
  }
  viewer_rig.cycle(3);
  EXPECT_EQ(viewer.view.age_cycles(), 3u);
  EXPECT_TRUE(viewer.view.valid());
  EXPECT_EQ(viewer.view.received(), 9u);
}

TEST_F(LentImages, AreMadeOverSeveralCyclesInOnePlace) {
  couple(viewer_rig, 1);
  make(1);
  camera.half = true;
  make(2);
  Image* const begun = camera.place;
  camera_rig->cycle(5);
  EXPECT_EQ(camera.place, begun);
  viewer_rig.cycle();
  EXPECT_EQ(viewer.number, 1u);
  camera.half = false;
  make(3);
  EXPECT_EQ(camera.place, begun);
  viewer_rig.cycle();
  EXPECT_EQ(viewer.number, 3u);
  EXPECT_EQ(viewer.view.count(), 2u);
}

TEST_F(LentImages, ReachEachOfSeveralConsumers) {
  couple(viewer_rig, 1);
  couple(other_rig, 2);
  make(1);
  viewer_rig.cycle();
  other_rig.cycle();
  EXPECT_EQ(viewer.seen, camera.place) << "the first link lends";
  EXPECT_NE(other.seen, camera.place) << "whom the supervisor gave memory of its own has a copy";
  EXPECT_EQ(viewer.number, 1u);
  EXPECT_EQ(other.number, 1u);
  EXPECT_EQ(other.wrong, 0u);
  // The first one goes: the next one lends.
  camera_rig->detach(1);
  camera_rig->settle();
  make(2);
  other_rig.cycle();
  EXPECT_EQ(other.seen, camera.place);
  EXPECT_EQ(other.number, 2u);
}

TEST_F(LentImages, AreLookedAtByAnyNumberInOneMemory) {
  std::vector<std::unique_ptr<Viewer>> viewers;
  std::vector<std::unique_ptr<Rig>> rigs;
  MemoryHandle shared;
  for (std::uint8_t link = 1; link <= 6; ++link) {
    viewers.push_back(std::make_unique<Viewer>());
    rigs.push_back(std::make_unique<Rig>(*viewers.back(), viewer_descriptor()));
    rigs.back()->bring_to(State::PreOperational);
    couple_into(shared, *rigs.back(), link);
  }
  for (std::uint64_t number = 1; number <= 3; ++number) {
    make(number);
    for (std::size_t i = 0; i < viewers.size(); ++i) {
      rigs[i]->cycle();
      ASSERT_EQ(viewers[i]->seen, camera.place) << "a copy for link " << i + 1;
      ASSERT_EQ(viewers[i]->number, number);
      ASSERT_EQ(viewers[i]->wrong, 0u);
      ASSERT_EQ(viewers[i]->view.lost(), 0u);
    }
  }
}

TEST_F(LentImages, OfOneMemoryStayWhileAnyOfItsLinksDoes) {
  MemoryHandle shared;
  couple_into(shared, viewer_rig, 1);
  couple_into(shared, other_rig, 2);
  camera.half = true;
  make(1);
  Image* const begun = camera.place;
  // The first link goes while an image is made: the other one's consumer gets it, and the first one hears of no end.
  viewer_rig.detach(1);
  viewer_rig.settle();
  camera_rig->detach(1);
  camera_rig->settle();
  EXPECT_EQ(camera.place, begun);
  camera.half = false;
  make(2);
  other_rig.cycle();
  EXPECT_EQ(other.seen, begun);
  EXPECT_EQ(other.number, 2u);
  EXPECT_EQ(other.view.status(), LinkStatus::Valid);
  // It comes back into the same memory with a later epoch, and has the newest image at once.
  couple_into(shared, viewer_rig, 1, 2);
  viewer_rig.cycle();
  EXPECT_EQ(viewer.seen, begun);
  EXPECT_EQ(viewer.view.lost(), 0u);
  camera_rig->detach(1);
  camera_rig->detach(2);
  camera_rig->settle();
  EXPECT_EQ(camera.image.lend(), nullptr) << "the last link took the memory along";
}

TEST_F(LentImages, OfASetWhoseMemoryTheProducerHasNotAreRefused) {
  MemoryHandle shared;
  couple_into(shared, viewer_rig, 1);
  camera_rig->detach(1);
  camera_rig->settle();
  const auto agreement = agree(other_rig, 2);
  EXPECT_EQ(attach(*camera_rig,
                   {.link = 2, .role = Role::Producer, .epoch = 3, .set = "IMAGE", .agreement = agreement, .made = 1},
                   shared),
            "1 4:010700")
      << "sealed: nobody becomes its producer again";
}

TEST_F(LentImages, ThatAreTooOldInhibitTheirConsumerAndNewOnesAreValidAgain) {
  operate();
  viewer_rig.cycle(40);
  EXPECT_TRUE(viewer.view.valid());
  EXPECT_EQ(viewer_rig.inhibited(), 0u);
  viewer_rig.cycle();
  EXPECT_FALSE(viewer.view.valid());
  EXPECT_NE(viewer_rig.inhibited(), 0u);
  EXPECT_EQ(viewer.number, 2u) << "it can still be looked at";
  make(3);
  viewer_rig.cycle();
  EXPECT_TRUE(viewer.view.valid());
}

TEST_F(LentImages, OfAProducerThatDiesInTheMiddleStayWholeAndGetOld) {
  operate();
  camera.half = true;
  make(3);
  camera_rig.reset();
  viewer.number = 0;
  viewer_rig.cycle(41);
  EXPECT_EQ(viewer.number, 2u) << "what it was making is nobody's";
  EXPECT_EQ(viewer.wrong, 0u);
  EXPECT_NE(viewer_rig.inhibited(), 0u);
  viewer_rig.service();
  EXPECT_EQ(viewer_rig.heard(descriptor::framework_event::set_stale(0)), 1);
}

TEST_F(LentImages, OfAProducerInFaultAreNotReliedOn) {
  operate();
  camera.fails = true;
  camera_rig->cycle();
  viewer_rig.cycle();
  EXPECT_EQ(viewer.view.status(), LinkStatus::Fault) << "told without an image";
  EXPECT_FALSE(viewer.view.valid());
  EXPECT_NE(viewer_rig.inhibited(), 0u);
}

TEST_F(LentImages, OfAProducerThatLeavesInOrderEndWithoutAnAlarm) {
  operate();
  ASSERT_EQ(camera_rig->set_state_now(State::PostOperational), "1 3 7");
  viewer_rig.cycle(100);
  viewer_rig.service();
  EXPECT_EQ(viewer.view.status(), LinkStatus::Stopping);
  EXPECT_FALSE(viewer.view.valid());
  EXPECT_EQ(viewer_rig.heard(descriptor::framework_event::set_stale(0)), 0);
  EXPECT_EQ(camera.image.lend(), nullptr) << "its links are given back";
}

TEST_F(LentImages, TellWhoLooksTooLong) {
  couple(viewer_rig, 1);
  make(1);
  viewer_rig.cycle();
  EXPECT_TRUE(viewer.view.whole());
  make(2);
  make(3);
  EXPECT_TRUE(viewer.view.whole()) << "two publications are its own";
  for (std::uint64_t number = 4; number <= 6; ++number) make(number);
  EXPECT_FALSE(viewer.view.whole());
  viewer_rig.cycle();
  EXPECT_EQ(viewer.number, 6u);
  EXPECT_EQ(viewer.view.lost(), 4u);
}

TEST_F(LentImages, EndWithTheirLink) {
  couple(viewer_rig, 1);
  make(1);
  viewer_rig.cycle();
  ASSERT_NE(viewer.seen, nullptr);
  viewer_rig.detach(1);
  camera_rig->detach(1);
  viewer_rig.settle();
  camera_rig->settle();
  EXPECT_EQ(viewer.view.look(), nullptr);
  EXPECT_FALSE(viewer.view.whole());
  EXPECT_FALSE(viewer.view.valid());
  EXPECT_EQ(camera.image.lend(), nullptr);
  make(2);
}

TEST_F(LentImages, AreNotAttachedAsWhatIsCopied) {
  auto agreement = agree(viewer_rig, 1);
  agreement.fields.back().count = 1000;
  agreement.kind = LinkKind::Latest;
  const LinkLayout layout{.epoch = 1,
                          .payload_octets = agreement.payload_octets(),
                          .layout_hash = agreement.layout_hash(),
                          .period = agreement.producer_period};
  const auto* latest = find_link_mechanism(standard_link_mechanisms(), agreement.method, agreement.kind);
  const auto shared = latest->establish(memory, layout).value();
  EXPECT_EQ(attach(*camera_rig, {1, Role::Producer, 1, "IMAGE", agreement}, shared), "1 4:010700");
  const auto writer = latest->produce(memory, shared, layout).value();
  EXPECT_EQ(attach(viewer_rig, {1, Role::Consumer, 1, "VIEW", agreement}, shared), "1 4:010700");
}

TEST_F(LentImages, AreNotAttachedToConsumersWithOtherFields) {
  const auto agreement = agree(viewer_rig, 1);
  const auto refused = [&](auto change) {
    auto changed = agreement;
    change(changed.fields);
    const auto shared = memory.create("x", 64).value();
    return attach(viewer_rig, {1, Role::Consumer, 1, "VIEW", changed}, shared);
  };
  EXPECT_EQ(refused([](auto& fields) { fields.push_back({"MORE", Type::Uint8, 1}); }), "1 4:010700");
  EXPECT_EQ(refused([](auto& fields) { std::swap(fields[1], fields[2]); }), "1 4:010700");
  EXPECT_EQ(refused([](auto& fields) { ++fields[3].count; }), "1 4:010700");
}

std::vector<std::string> mistakes(Subsystem& author, const std::string& descriptor) {
  Rig rig{author, descriptor};
  std::vector<std::string> told;
  for (const Mistake& mistake : rig.subsystem.try_introduction()) told.push_back(mistake.text);
  return told;
}

TEST(LentImagesMistakes, AreToldInSoftwareInit) {
  constexpr auto other = R"(<Field name="NUMBER" type="UINT64"/>)";
  constexpr auto same_number = R"(<Field name="NUMBER" type="UINT64"/><Field name="WIDTH" type="UINT16"/>
    <Field name="HEIGHT" type="UINT16"/><Field name="PIXEL" type="UINT8" count="1048577"/>)";
  Camera camera;
  EXPECT_THAT(mistakes(camera, camera_descriptor(other)),
              ElementsAre("lend_link IMAGE: the C++ type has 4 members, the descriptor declares 1 fields"));
  EXPECT_THAT(
      mistakes(camera, camera_descriptor(same_number)),
      ElementsAre("lend_link IMAGE: field PIXEL: C++ has UINT8[1048576], the descriptor declares UINT8[1048577]"));
  EXPECT_THAT(mistakes(camera, viewer_descriptor()),
              ElementsAre("lend_link: no configuration lends a set 'IMAGE'",
                          "require_link VIEW: the set is required and has no port"));
  Viewer viewer;
  EXPECT_THAT(mistakes(viewer, viewer_descriptor(other)),
              ElementsAre("require_link VIEW: the C++ type has 4 members, the descriptor declares 1 fields"));
  struct Idle final : Subsystem {
  } idle;
  EXPECT_THAT(mistakes(idle, camera_descriptor()),
              ElementsAre("set lent but without a place to make it, lend_link: IMAGE"));
}

TEST(LentImagesMistakes, APortThatCopiesIsNoneOfALentSetAndTheReverse) {
  struct Number {
    std::uint64_t number;
  };
  constexpr auto number = R"(<Field name="NUMBER" type="UINT64"/>)";
  struct Copies final : Subsystem {
    LinkInput<Number> view;
    Result<Step> software_init() override {
      require_link("VIEW", view);
      return done;
    }
  } copies;
  Rig rig{copies, viewer_descriptor(number)};
  EXPECT_THAT(rig.set_state_now(State::PreOperational), ::testing::HasSubstr("8:"));
  EXPECT_THAT(rig.explanations, ElementsAre(::testing::HasSubstr("VIEW: is lent, its port is no LoanInput")));
  struct Borrows final : Subsystem {
    LoanInput<Number> view;
    Result<Step> software_init() override {
      require_link("VIEW", view);
      return done;
    }
  } borrows;
  std::string copied = viewer_descriptor(number);
  copied.replace(copied.find("loaned"), 6, "latest");
  Rig copied_rig{borrows, copied};
  EXPECT_THAT(copied_rig.set_state_now(State::PreOperational), ::testing::HasSubstr("8:"));
  EXPECT_THAT(copied_rig.explanations, ElementsAre(::testing::HasSubstr("VIEW: is copied, its port is no LinkInput")));
}

}  // namespace
}  // namespace hirosco::images
