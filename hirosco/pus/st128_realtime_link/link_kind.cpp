// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

namespace hirosco::pus::st128 {
namespace kind {

constexpr Part word(std::string_view name) noexcept { return {.name = name, .form = Form::Word}; }

constexpr Part link[]{number("LINK", Type::Uint8)};
constexpr Part link_end[]{number("LINK", Type::Uint8), number("ROLE", Type::Uint8)};
constexpr Part choice[]{number("CHOICE", Type::Uint8)};
constexpr Part field[]{word("FIELD"), number("TYPE", Type::Uint8), number("COUNT", Type::Uint32)};
constexpr Part asked[]{number("LINK", Type::Uint8), word("SET")};
constexpr Part offered[]{
    number("LINK", Type::Uint8), word("SET"),           number("PERIOD_NS", Type::Int64), list("METHODS", choice),
    list("BYTE_ORDERS", choice), list("KINDS", choice), number("DEPTH", Type::Uint16),    number("WAKES", Type::Uint8),
    list("FIELDS", field)};
constexpr Part terms[]{number("LINK", Type::Uint8),
                       word("SET"),
                       number("LINK", Type::Uint8),
                       word("SET"),
                       number("PERIOD_NS", Type::Int64),
                       list("METHODS", choice),
                       list("BYTE_ORDERS", choice),
                       list("KINDS", choice),
                       number("DEPTH", Type::Uint16),
                       number("WAKES", Type::Uint8),
                       list("FIELDS", field)};
constexpr Part agreed[]{number("LINK", Type::Uint8),
                        number("METHOD", Type::Uint8),
                        number("BYTE_ORDER", Type::Uint8),
                        number("KIND", Type::Uint8),
                        number("DEPTH", Type::Uint16),
                        number("WAKES", Type::Uint8),
                        number("PRODUCER_PERIOD_NS", Type::Int64),
                        number("CONSUMER_PERIOD_NS", Type::Int64),
                        list("FIELDS", field)};
constexpr Part attachment[]{number("LINK", Type::Uint8),
                            number("ROLE", Type::Uint8),
                            number("EPOCH", Type::Uint32),
                            number("MADE", Type::Uint32),
                            word("SET"),
                            number("METHOD", Type::Uint8),
                            number("BYTE_ORDER", Type::Uint8),
                            number("KIND", Type::Uint8),
                            number("DEPTH", Type::Uint16),
                            number("WAKES", Type::Uint8),
                            number("PRODUCER_PERIOD_NS", Type::Int64),
                            number("CONSUMER_PERIOD_NS", Type::Int64),
                            list("FIELDS", field),
                            word("PRODUCER_AT"),
                            word("CONSUMER_AT"),
                            number("KEY", Type::Uint64)};
constexpr Part standing[]{number("LINK", Type::Uint8), number("ROLE", Type::Uint8), word("AT"),
                          number("KEY", Type::Uint64)};
constexpr Part reached[]{number("LINK", Type::Uint8), number("EPOCH", Type::Uint32), word("CONSUMER_AT")};
constexpr Part refused[]{number("LINK", Type::Uint8), number("ITEM", Type::Uint8), word("WHY")};

constexpr RequestKind requests[]{{request_offer, "REQUEST_OFFER", asked},
                                 {negotiate_terms, "NEGOTIATE", terms},
                                 {attach, "ATTACH", attachment},
                                 {detach, "DETACH", link},
                                 {reach, "REACH", reached}};
constexpr ReportKind reports[]{{offer, "OFFER", offered},
                               {agreement, "AGREEMENT", agreed},
                               {refusal, "REFUSAL", refused},
                               {attached, "ATTACHED", standing},
                               {detached, "DETACHED", link_end}};

}  // namespace kind

const ServiceKind service_kind{.type = service_type,
                               .name = "real-time links",
                               .needs = Needs::SupervisorAsks,
                               .requests = kind::requests,
                               .reports = kind::reports};

}  // namespace hirosco::pus::st128
