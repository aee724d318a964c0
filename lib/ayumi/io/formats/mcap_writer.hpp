#pragma once
// MCAP, the container of Foxglove for messages of many topics in the order of time, after the
// public specification, version 0 (mcap.dev/spec). A file is
//   magic, Header, Schemas, Channels, Metadata, (Chunk, MessageIndex per channel)*, DataEnd,
//   Schemas, Channels, Statistics, ChunkIndexes, MetadataIndexes, SummaryOffsets, Footer, magic
// Every record is an opcode (1 byte), its length (8 bytes) and its content. Chunks contain messages
// and are compressed by zstd; their CRC-32, that of the data section and that of the summary are
// written. All numbers are little-endian.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace ayumi {

class McapWriter {
 public:
  using Metadata = std::map<std::string, std::string>;

  /// `library` names the program that writes.
  explicit McapWriter(const std::string& library);

  /// Metadata, schemas and channels must be added before the first message.
  void add_metadata(const std::string& name, const Metadata& values);
  /// Adds a topic whose messages are JSON of the form that `json_schema` describes. Returns its
  /// channel.
  std::uint16_t add_channel(const std::string& topic, const std::string& schema_name,
                            const std::string& json_schema);

  /// `time` [ns] must not be before the time of the previous message.
  void add_message(std::uint16_t channel, std::uint64_t time, const std::string& json);

  /// Returns the whole file. Nothing can be added afterwards.
  std::string finish();

  /// The number of messages of each channel so far.
  const std::map<std::uint16_t, std::uint64_t>& counts() const { return counts_; }

 private:
  struct Entry {
    std::uint64_t time, offset;
  };
  struct ChunkIndex {
    std::uint64_t begin, end, offset, length;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
    std::uint64_t index_length, compressed, uncompressed;
  };
  struct MetadataIndex {
    std::uint64_t offset, length;
    std::string name;
  };

  void close_chunk();

  std::string file_;
  /// Whole records, which are repeated in the summary.
  std::vector<std::string> schemas_, channels_;
  std::vector<MetadataIndex> metadata_;
  std::vector<ChunkIndex> chunks_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint64_t first_ = 0, last_ = 0;  ///< times of the first and the last message
  bool any_ = false;

  // The chunk that is being filled.
  std::string chunk_;
  std::uint64_t chunk_begin_ = 0;
  std::map<std::uint16_t, std::vector<Entry>> chunk_entries_;
};

}  // namespace ayumi
