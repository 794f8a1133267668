/// to_mcap: any bag in, the same messages as MCAP out.
#include <console_bridge/console.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <fstream>
#include <iostream>

#include "hammer_loads/commands/command_line.h"
#include "hammer_loads/commands/output_file.h"
#include "hammer_loads/ros/mcap_writer.h"

namespace hammer_loads {
namespace {

constexpr char kLibrary[] = "hammer_loads to_mcap";

/// Reason why an existing file must stay; empty: this command wrote it.
std::string whyMcapMustStay(const std::string& name) {
  std::string begin(64, '\0');
  std::ifstream(name, std::ios::binary).read(begin.data(), static_cast<std::streamsize>(begin.size()));
  const bool ours = begin.compare(1, 4, "MCAP") == 0 && begin.find(kLibrary) != std::string::npos;
  return ours ? "" : "it is no MCAP of this command";
}

/// Publisher and type of a connection's messages (profile ros1).
McapWriter::Metadata metadataOf(const rosbag::ConnectionInfo& connection) {
  McapWriter::Metadata metadata{{"md5sum", connection.md5sum}};
  if (!connection.header) return metadata;
  const auto caller = connection.header->find("callerid"), latching = connection.header->find("latching");
  if (caller != connection.header->end()) metadata["callerid"] = caller->second;
  if (latching != connection.header->end()) metadata["latching"] = latching->second == "1" ? "true" : "false";
  return metadata;
}

/// Number of messages written.
std::uint64_t convert(const std::string& input, const std::string& output) {
  rosbag::Bag bag(input);
  rosbag::View view(bag);
  McapWriter writer(output, kLibrary);
  std::map<std::pair<std::string, std::string>, std::uint16_t> schemas;  // by type and md5
  std::map<std::uint32_t, std::uint16_t> channels;                       // by connection
  for (const rosbag::ConnectionInfo* connection : view.getConnections()) {
    const auto [schema, is_new] = schemas.try_emplace({connection->datatype, connection->md5sum});
    if (is_new) schema->second = writer.addSchema(connection->datatype, connection->msg_def);
    channels[connection->id] = writer.addChannel(schema->second, connection->topic, metadataOf(*connection));
  }
  std::map<const ros::M_string*, std::uint16_t> by_header;  // a message leads to its connection's header alone
  for (const rosbag::ConnectionInfo* connection : view.getConnections())
    by_header[connection->header.get()] = channels[connection->id];
  std::uint64_t count = 0;
  std::string bytes;
  for (const rosbag::MessageInstance& message : view) {
    bytes.resize(message.size());
    ros::serialization::OStream stream(reinterpret_cast<std::uint8_t*>(bytes.data()), message.size());
    message.write(stream);
    writer.write(by_header.at(message.getConnectionHeader().get()), message.getTime().toNSec(), bytes);
    ++count;
  }
  writer.close();
  return count;
}

int run(int argc, const char* const* argv) {
  console_bridge::setLogLevel(console_bridge::CONSOLE_BRIDGE_LOG_ERROR);
  CommandLine line("Every message of a bag as MCAP, profile ros1", "to_mcap");
  std::string input, output;
  bool force = false;
  line.add_option("input", input, "any bag")->required()->type_name("IN.bag");
  line.add_option("output", output, "to write, which must not exist")->required()->type_name("OUT.mcap");
  line.add_flag("--force", force, "replace OUT.mcap if this command wrote it");
  if (const auto code = line.parse(argc, argv)) return *code;
  endCleanlyOnSignals();
  Checked<OutputFile> file = OutputFile::make({output, {input}, force, whyMcapMustStay});
  std::string problem = file.value ? "" : file.problems.front();
  std::uint64_t count = 0;
  if (file.value) {
    try {
      count = convert(input, file.value->path());
      problem = file.value->publish();
    } catch (const std::ios_base::failure&) {
      problem = output + ": cannot be written";
    } catch (const std::exception& error) {
      problem = input + ": cannot be read: " + error.what();
    }
  }
  if (!problem.empty()) return fail({problem});
  std::cout << output << ": " << count << " messages" << std::endl;
  return 0;
}

}  // namespace
}  // namespace hammer_loads

int main(int argc, char** argv) { return hammer_loads::run(argc, argv); }
