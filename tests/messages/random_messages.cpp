// SPDX-License-Identifier: MIT
#include "tests/messages/random_messages.h"

#include <camway/members.h>

#include <algorithm>
#include <bit>
#include <concepts>
#include <string>
#include <type_traits>
#include <vector>

#include "lcmtypes/wire/channels.h"
#include "lcmtypes/wire/layout.h"

namespace camway::testing {
namespace {

/// Approximate size of a long list; three of these fit into a message. [Units: bytes]
constexpr std::size_t kListBytes = 16'000;

std::string client_id(Random& random) {
  constexpr std::string_view kAlphabet =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  std::string id(1 + below(random, wire::kMaxClientIdLength), ' ');
  for (char& c : id) c = kAlphabet[below(random, kAlphabet.size())];
  return id;
}

/// Returns the length of a list, mostly a short one and sometimes a long one.
std::size_t length(Random& random, std::size_t longest) {
  const std::size_t most = below(random, 8) == 0 ? longest : std::min<std::size_t>(longest, 4);
  return below(random, most + 1);
}

/// Sets every member that `camway/members.h` lists to a random value of its type.
struct Filler {
  Random& random;

  void fill(double& value) const { value = std::bit_cast<double>(random()); }
  /// Half of the numbers are small, as those of enumerations, pages and vertices are.
  void fill(std::integral auto& value) const {
    using Number = std::remove_reference_t<decltype(value)>;
    value = below(random, 2) == 0 ? static_cast<Number>(below(random, 14))
                                  : static_cast<Number>(random());
  }
  template <class Element, std::size_t kCount>
  void fill(Element (&values)[kCount]) const {
    for (Element& value : values) fill(value);
  }
  template <wire::Described Message>
  void fill(Message& message) const {
    wire::for_each_member<Message>([&](const auto& member) { fill_member(message, member); });
    if constexpr (std::same_as<Message, body_t>) {
      // In half of the bodies, the pieces have as many points as there are.
      if (below(random, 2) == 0)
        message.piece_sizes = {static_cast<std::int32_t>(message.points_m.size())};
    }
    wire::set_counts(message);
  }

 private:
  template <class Message, class Pointer>
  void fill_member(Message& message, const wire::Plain<Pointer>& member) const {
    fill(message.*member.member);
  }
  template <class Message>
  void fill_member(Message& message, const wire::Text<Message>& member) const {
    std::string& text = message.*member.member;
    if (member.name == "client_id") {
      text = client_id(random);
      return;
    }
    text.assign(below(random, member.max_bytes + 1), ' ');
    for (char& c : text) c = static_cast<char>(1 + below(random, 255));
  }
  template <class Message, class Element>
  void fill_member(Message& message, const wire::List<Message, Element>& member) const {
    const std::size_t element_bytes = sizeof(Element) * std::max<std::size_t>(member.columns, 1);
    std::vector<Element>& list = message.*member.member;
    list.resize(length(random, kListBytes / element_bytes));
    for (Element& element : list) {
      if constexpr (requires { element.begin(); }) {
        element.resize(member.columns);
        for (auto& value : element) fill(value);
      } else {
        fill(element);
      }
    }
  }
};

}  // namespace

std::size_t below(Random& random, std::size_t below) { return random() % below; }

template <class Message>
Message random_message(Random& random) {
  Message message{};
  Filler{random}.fill(message);
  // Half of the messages pass the first check and reach the lists.
  if constexpr (requires { message.page, message.num_pages; }) {
    if (below(random, 2) == 0) {
      message.page = 0;
      message.num_pages = 1;
    }
  }
  return message;
}

template cancel_t random_message(Random&);
template claim_t random_message(Random&);
template envelope_t random_message(Random&);
template error_t random_message(Random&);
template fleet_answer_t random_message(Random&);
template fleet_job_t random_message(Random&);
template map_page_t random_message(Random&);
template missing_pages_t random_message(Random&);
template occupancy_request_t random_message(Random&);
template occupancy_response_t random_message(Random&);
template plan_progress_t random_message(Random&);
template plan_request_t random_message(Random&);
template plan_response_t random_message(Random&);
template planner_status_t random_message(Random&);
template scene_request_t random_message(Random&);
template scene_response_t random_message(Random&);
template status_t random_message(Random&);
template upload_page_t random_message(Random&);
template upload_status_t random_message(Random&);
template watch_report_t random_message(Random&);
template watch_t random_message(Random&);

}  // namespace camway::testing
