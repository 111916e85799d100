#include "viewer/outbox.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "viewer/surface_blocks.h"

namespace nextview {
namespace {

using Json = nlohmann::json;
using Bytes = std::vector<std::uint8_t>;

enum class Kind : std::uint8_t { Blocks = 1, Scan = 2, Tried = 3, Cad = 4 };

constexpr int kRowsAMessage = 200;

Outbox::Message text(const std::string& json) { return {false, {json.begin(), json.end()}}; }

Outbox::Message binary(Kind kind, std::size_t run, int view, std::uint32_t count,
                       const Bytes& body) {
  Bytes bytes;
  append_number(bytes, static_cast<std::uint8_t>(kind));
  append_number(bytes, static_cast<std::uint8_t>(run));
  append_number(bytes, std::uint16_t{0});
  append_number(bytes, static_cast<std::uint32_t>(view));
  append_number(bytes, count);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return {true, std::move(bytes)};
}

std::optional<int> view_of(const Json& view) {
  if (view.is_null()) return std::nullopt;
  const auto number = view.get<std::int64_t>();
  if (number < 0 || number >= kAnyView) throw std::runtime_error("no view has that number");
  return static_cast<int>(number);
}

}  // namespace

Outbox::Side& Outbox::side_of(const Json& number) {
  const auto run = number.get<std::int64_t>();
  if (run < 0 || static_cast<std::size_t>(run) >= sides_.size()) {
    throw std::runtime_error("no run has that number");
  }
  return sides_[static_cast<std::size_t>(run)];
}

void Outbox::take(const std::string& said, const std::function<void()>& changed) {
  const Json json = Json::parse(said);
  if (json.contains("got")) {
    got_ = std::clamp(json.at("got").get<std::int64_t>(), got_, sent_);
  } else if (json.contains("show")) {
    Side& side = side_of(json.at("show"));
    side.shown = true;
    side.wanted = view_of(json.at("view"));
  } else if (json.contains("hide")) {
    side_of(json.at("hide")).shown = false;
  } else if (json.contains("pace")) {
    side_of(json.at("pace"));
    runs_[json.at("pace").get<std::size_t>()].viewed.set_pace(
        view_of(json.at("last_view")).value_or(kAnyView));
  } else if (json.contains("cad")) {
    side_of(json.at("cad")).wants_cad = true;
    ServedRun& run = runs_[json.at("cad").get<std::size_t>()];
    if (const auto config = run.viewed.config()) run.cad.load(*config, changed);
  } else {
    throw std::runtime_error("it says nothing");
  }
}

std::optional<Outbox::Message> Outbox::next() {
  if (sent_ - got_ >= kWindow) return std::nullopt;
  for (std::size_t run = 0; run < sides_.size(); ++run) {
    if (auto message = next_of(run)) {
      ++sent_;
      return message;
    }
  }
  return std::nullopt;
}

std::optional<Outbox::Message> Outbox::next_of(std::size_t run) {
  Side& side = sides_[run];
  const ViewedRun& viewed = runs_[run].viewed;
  if (const ViewedRun::Facts facts = viewed.facts(); facts.version != side.facts_version) {
    side.facts_version = facts.version;
    return text(fmt::format(R"({{"kind":"facts","run":{},"runs":{},"facts":{}}})", run,
                            sides_.size(), facts.json));
  }
  if (!side.shown) return std::nullopt;
  const int views = viewed.views();
  if (side.rows < views) {
    const int first = side.rows + 1;
    side.rows = std::min(views, side.rows + kRowsAMessage);
    return text(fmt::format(R"({{"kind":"rows","run":{},"first":{},"rows":{}}})", run, first,
                            viewed.rows(first, side.rows - first + 1)));
  }
  return next_of_view(run, std::min(side.wanted.value_or(views), views));
}

std::optional<Outbox::Message> Outbox::next_of_view(std::size_t run, int view) {
  Side& side = sides_[run];
  const ViewedRun& viewed = runs_[run].viewed;
  if (side.view != view) {
    side.view = view;
    side.next_block = 0;
    side.complete = false;
  }
  if (!side.complete) {
    const auto changes = viewed.changes(view, side.blocks, side.next_block, kMessageBytes);
    if (changes.blocks > 0) return binary(Kind::Blocks, run, view, changes.blocks, changes.bytes);
    side.complete = true;
    return text(fmt::format(R"({{"kind":"shown","run":{},"view":{}}})", run, view));
  }
  if (side.scan_view != view && view > 0) {
    side.scan_view = view;
    return binary(Kind::Scan, run, view, 0, viewed.scan(view));
  }
  if (auto message = next_after(run, view)) return message;
  return next_cad(run);
}

std::optional<Outbox::Message> Outbox::next_after(std::size_t run, int view) {
  Side& side = sides_[run];
  const ViewedRun& viewed = runs_[run].viewed;
  const int version = viewed.after_version(view);
  if (side.after_view != view || side.after_version != version) {
    side.after_view = view;
    side.after_version = version;
    side.tried_sent = side.next_sent = false;
  }
  if (!side.tried_sent) {
    side.tried_sent = true;
    const Bytes tried = viewed.after(view).tried;
    constexpr std::size_t kBytesAPosition = 16;
    return binary(Kind::Tried, run, view,
                  static_cast<std::uint32_t>(tried.size() / kBytesAPosition), tried);
  }
  if (!side.next_sent) {
    side.next_sent = true;
    const std::string next = viewed.after(view).next;
    return text(fmt::format(R"({{"kind":"next","run":{},"view":{},"next":{}}})", run, view,
                            next.empty() ? "null" : next));
  }
  return std::nullopt;
}

std::optional<Outbox::Message> Outbox::next_cad(std::size_t run) {
  if (!sides_[run].wants_cad) return std::nullopt;
  const CadModel::Answer answer = runs_[run].cad.answer();
  if (!answer.there) return std::nullopt;
  sides_[run].wants_cad = false;
  if (answer.mesh) return binary(Kind::Cad, run, 0, answer.mesh->vertices, answer.mesh->bytes);
  return text(Json{{"kind", "no_cad"}, {"run", run}, {"why", answer.failure}}.dump(
      -1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace nextview
