/// Writing an MCAP file (mcap.dev/spec, version 0) of profile ros1: chunks without compression, with CRCs, indexes and
/// summary. Independent of ROS and of the hammer.
#pragma once

#include <boost/crc.hpp>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace hammer_loads {

/// A file that is being written; it is valid only once it is closed. Throws std::ios_base::failure where the file
/// cannot be written.
class McapWriter {
 public:
  using Metadata = std::map<std::string, std::string>;

  McapWriter(const std::string& file, const std::string& library);
  /// Number of a message definition, for addChannel().
  std::uint16_t addSchema(const std::string& type, const std::string& definition);
  std::uint16_t addChannel(std::uint16_t schema, const std::string& topic, const Metadata& metadata);
  /// time [ns].
  void write(std::uint16_t channel, std::uint64_t time, const std::string& bytes);
  /// Writes the rest and the summary.
  void close();

 private:
  struct Span {
    std::uint64_t first{~std::uint64_t{0}}, last{};  ///< [ns]
    void add(std::uint64_t time);
  };
  using Places = std::vector<std::pair<std::uint64_t, std::uint64_t>>;  ///< time [ns] and place in the chunk

  void put(const std::string& bytes);
  void writeChunk();
  std::string statistics() const;

  std::ofstream stream_;
  std::uint64_t position_{};
  boost::crc_32_type data_crc_;
  std::vector<std::string> schemas_, channels_, chunk_indexes_;  ///< records
  std::map<std::uint16_t, std::uint64_t> counts_;                ///< messages by channel
  std::string chunk_;
  Span chunk_span_, span_;
  std::map<std::uint16_t, Places> places_;  ///< places of the chunk's messages, by channel
};

}  // namespace hammer_loads
