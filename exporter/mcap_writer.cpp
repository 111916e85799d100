#include "exporter/mcap_writer.h"

#include <zlib.h>

#include <limits>
#include <stdexcept>
#include <utility>

namespace nextview {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = 1 << 20;

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

// The content of a record: little-endian numbers, strings and arrays with their length before them.
class Content {
 public:
  template <class Number>
  Content& number(Number value) {
    for (std::size_t byte = 0; byte < sizeof value; ++byte) {
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * byte));
    }
    return *this;
  }
  Content& string(const std::string& text) {
    number(static_cast<std::uint32_t>(text.size()));
    bytes_ += text;
    return *this;
  }
  Content& raw(const std::string& bytes) {
    bytes_ += bytes;
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

  std::string record(std::uint8_t opcode) const {
    return Content().number(opcode).number(std::uint64_t{bytes_.size()}).bytes() + bytes_;
  }

 private:
  std::string bytes_;
};

std::uint32_t crc_of(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace

McapWriter::McapWriter(std::ostream& out) : out_(out) {
  put(std::string(kMagic));
  put(Content().string("").string("nextview").record(kHeader));
}

void McapWriter::put(const std::string& bytes) {
  out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  written_ += bytes.size();
}

std::uint16_t McapWriter::add_json_channel(const std::string& topic, const std::string& schema_name,
                                           const std::string& json_schema) {
  const auto [schema, is_new] =
      schemas_.emplace(schema_name, static_cast<std::uint16_t>(schemas_.size() + 1));
  if (is_new) {
    schema_records_[schema->second] = Content()
                                          .number(schema->second)
                                          .string(schema_name)
                                          .string("jsonschema")
                                          .string(json_schema)
                                          .record(kSchema);
    chunk_ += schema_records_[schema->second];
  }
  const auto id = static_cast<std::uint16_t>(channels_.size() + 1);
  channels_[id].record = Content()
                             .number(id)
                             .number(schema->second)
                             .string(topic)
                             .string("json")
                             .number(std::uint32_t{0})  // no metadata
                             .record(kChannel);
  chunk_ += channels_[id].record;
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint64_t time_ns, const std::string& message) {
  if (time_ns < last_ns_) throw std::invalid_argument("a message is older than the one before");
  Channel& to = channels_.at(channel);
  if (messages_++ == 0) first_ns_ = time_ns;
  if (chunk_index_.empty()) chunk_start_ns_ = time_ns;
  last_ns_ = time_ns;
  chunk_index_[channel].push_back({time_ns, chunk_.size()});
  chunk_ += Content()
                .number(channel)
                .number(to.messages++)
                .number(time_ns)
                .number(time_ns)
                .raw(message)
                .record(kMessage);
  if (chunk_.size() >= kChunkBytes) end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::uint64_t start = written_;
  const std::string chunk = std::exchange(chunk_, {});
  const std::uint64_t end_ns = chunk_index_.empty() ? 0 : last_ns_;
  const std::uint64_t start_ns = chunk_index_.empty() ? 0 : chunk_start_ns_;
  put(Content()
          .number(start_ns)
          .number(end_ns)
          .number(std::uint64_t{chunk.size()})
          .number(crc_of(chunk))
          .string("")  // not compressed
          .number(std::uint64_t{chunk.size()})
          .raw(chunk)
          .record(kChunk));
  const std::uint64_t chunk_length = written_ - start;
  const std::uint64_t indexes_start = written_;
  Content offsets;
  for (const auto& [channel, entries] : std::exchange(chunk_index_, {})) {
    offsets.number(channel).number(written_);
    Content times;
    for (const IndexEntry& entry : entries) times.number(entry.time_ns).number(entry.offset);
    put(Content().number(channel).string(times.bytes()).record(kMessageIndex));
  }
  chunk_indexes_ += Content()
                        .number(start_ns)
                        .number(end_ns)
                        .number(start)
                        .number(chunk_length)
                        .string(offsets.bytes())
                        .number(written_ - indexes_start)
                        .string("")
                        .number(std::uint64_t{chunk.size()})
                        .number(std::uint64_t{chunk.size()})
                        .record(kChunkIndex);
  ++chunks_;
}

void McapWriter::finish() {
  end_chunk();
  put(Content().number(std::uint32_t{0}).record(kDataEnd));  // 0: no CRC of the whole

  std::string schemas, channels;
  for (const auto& [id, record] : schema_records_) schemas += record;
  Content counts;
  for (const auto& [id, channel] : channels_) {
    channels += channel.record;
    counts.number(id).number(std::uint64_t{channel.messages});
  }
  const std::string statistics = Content()
                                     .number(messages_)
                                     .number(static_cast<std::uint16_t>(schemas_.size()))
                                     .number(static_cast<std::uint32_t>(channels_.size()))
                                     .number(std::uint32_t{0})  // attachments
                                     .number(std::uint32_t{0})  // metadata
                                     .number(chunks_)
                                     .number(first_ns_)
                                     .number(last_ns_)
                                     .string(counts.bytes())
                                     .record(kStatistics);
  const std::uint64_t summary_start = written_;
  std::string summary, offsets;
  for (const auto& [opcode, group] :
       {std::pair(kSchema, schemas), std::pair(kChannel, channels),
        std::pair(kStatistics, statistics), std::pair(kChunkIndex, chunk_indexes_)}) {
    if (group.empty()) continue;
    offsets += Content()
                   .number(static_cast<std::uint8_t>(opcode))
                   .number(summary_start + summary.size())
                   .number(std::uint64_t{group.size()})
                   .record(kSummaryOffset);
    summary += group;
  }
  const std::uint64_t offsets_start = summary_start + summary.size();
  const std::string footer_begin = Content()
                                       .number(static_cast<std::uint8_t>(kFooter))
                                       .number(std::uint64_t{8 + 8 + 4})
                                       .number(summary_start)
                                       .number(offsets_start)
                                       .bytes();
  const std::string end = summary + offsets + footer_begin;
  put(end + Content().number(crc_of(end)).bytes() + std::string(kMagic));
}

}  // namespace nextview
