#pragma once

#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

namespace nextview {

/// Writes an MCAP file (https://mcap.dev/spec, major version 0): messages in chunks, not
/// compressed, with CRCs, and an index of all of it at the end, so that readers jump to any time.
class McapWriter {
 public:
  /// Writes the beginning. The stream must outlive the object.
  explicit McapWriter(std::ostream& out);

  /// A topic whose messages are JSON described by a JSON schema.
  /// @param schema_name such as "foxglove.PointCloud"; a name always with the same schema
  /// @return the channel, for write()
  std::uint16_t add_json_channel(const std::string& topic, const std::string& schema_name,
                                 const std::string& json_schema);

  /// @param time_ns no earlier than that of the message before
  void write(std::uint16_t channel, std::uint64_t time_ns, const std::string& message);

  /// Writes the index and the end. To be called once, last.
  void finish();

 private:
  struct Channel {
    std::string record;  ///< what stands in the file
    std::uint32_t messages = 0;
  };
  struct IndexEntry {
    std::uint64_t time_ns;
    std::uint64_t offset;
  };

  void put(const std::string& bytes);
  void end_chunk();

  std::ostream& out_;
  std::uint64_t written_ = 0;
  std::map<std::string, std::uint16_t> schemas_;  ///< by name
  std::map<std::uint16_t, std::string> schema_records_;
  std::map<std::uint16_t, Channel> channels_;
  std::string chunk_;  ///< records of the chunk that is not written yet
  std::map<std::uint16_t, std::vector<IndexEntry>> chunk_index_;
  std::uint64_t chunk_start_ns_ = 0;
  std::string chunk_indexes_;  ///< records for the summary
  std::uint32_t chunks_ = 0;
  std::uint64_t messages_ = 0;
  std::uint64_t first_ns_ = 0;
  std::uint64_t last_ns_ = 0;
};

}  // namespace nextview
