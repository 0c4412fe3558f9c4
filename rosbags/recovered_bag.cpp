// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
#include "planecloud_slam/rosbags/recovered_bag.h"

#include <ros/header.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>
#include <unistd.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <vector>

namespace planecloud {
namespace {

using Bytes = std::vector<std::uint8_t>;
constexpr std::uint32_t kLongestRecord = 1U << 30;  // [B], far above any image

std::uint32_t readUint32(const std::uint8_t* bytes) {
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::uint32_t>(bytes[3]) << 24;
}

/// One record of the format: header fields and content.
struct Record {
  ros::M_string fields;
  const std::uint8_t* content = nullptr;
  std::uint32_t content_size = 0;
  std::uint32_t missing = 0;  ///< bytes of the content that the file no longer has

  [[nodiscard]] int op() const {
    const auto field = fields.find(rosbag::OP_FIELD_NAME);
    return field == fields.end() || field->second.empty() ? -1 : field->second[0];
  }
  [[nodiscard]] std::uint32_t number(const std::string& name, std::size_t offset = 0) const {
    const auto field = fields.find(name);
    if (field == fields.end() || field->second.size() < offset + 4) {
      throw rosbag::BagFormatException("a record has no field '" + name + "'");
    }
    return readUint32(reinterpret_cast<const std::uint8_t*>(field->second.data()) + offset);
  }
};

/// Takes records off a range of bytes, one after the other.
class RecordReader {
 public:
  RecordReader(const std::uint8_t* bytes, std::size_t size) : bytes_(bytes), left_(size) {}

  /// Nothing when the rest is no complete header. The content may end early: see Record::missing.
  [[nodiscard]] std::optional<Record> next() {
    std::uint32_t header_size = 0;
    const std::uint8_t* header = nullptr;
    Record record;
    if (!take(header_size) || header_size > left_) return std::nullopt;
    header = bytes_;
    skip(header_size);
    ros::Header fields;
    std::string error;
    if (!fields.parse(const_cast<std::uint8_t*>(header), header_size, error)) return std::nullopt;
    if (!take(record.content_size) || record.content_size > kLongestRecord) return std::nullopt;
    record.fields = *fields.getValues();
    record.content = bytes_;
    if (record.content_size > left_) {
      record.missing = record.content_size - static_cast<std::uint32_t>(left_);
      record.content_size = static_cast<std::uint32_t>(left_);
    }
    skip(record.content_size);
    return record;
  }

 private:
  bool take(std::uint32_t& number) {
    if (left_ < 4) return false;
    number = readUint32(bytes_);
    skip(4);
    return true;
  }
  void skip(std::size_t count) {
    bytes_ += count;
    left_ -= count;
  }

  const std::uint8_t* bytes_;
  std::size_t left_;
};

/// Copies chunks into a new bag.
class ChunkCopier {
 public:
  explicit ChunkCopier(rosbag::Bag& bag) : bag_(bag) {}

  [[nodiscard]] std::size_t messages() const { return messages_; }

  void copy(const Record& chunk) {
    const std::string& compression = chunk.fields.at(rosbag::COMPRESSION_FIELD_NAME);
    if (compression == rosbag::COMPRESSION_NONE) {
      copyRecords(chunk.content, chunk.content_size);
      return;
    }
    if (chunk.missing > 0) return;  // a compressed chunk is whole or nothing
    const std::uint32_t size = chunk.number(rosbag::SIZE_FIELD_NAME);
    if (size > kLongestRecord) throw rosbag::BagFormatException("a chunk has an absurd size");
    const Bytes plain = decompress(chunk, compression, size);
    copyRecords(plain.data(), plain.size());
  }

 private:
  static Bytes decompress(const Record& chunk, const std::string& compression, std::uint32_t size) {
    Bytes plain(size);
    const auto type = compression == rosbag::COMPRESSION_LZ4 ? rosbag::compression::LZ4
                                                             : rosbag::compression::BZ2;
    rosbag::ChunkedFile no_file;
    const auto stream = rosbag::StreamFactory(&no_file).getStream(type);
    try {
      stream->decompress(plain.data(), size, const_cast<std::uint8_t*>(chunk.content),
                         chunk.content_size);
    } catch (const rosbag::BagException& error) {
      throw rosbag::BagFormatException(error.what());
    }
    return plain;
  }

  void copyRecords(const std::uint8_t* bytes, std::size_t size) {
    RecordReader reader(bytes, size);
    while (const std::optional<Record> record = reader.next()) {
      if (record->missing > 0) return;
      if (record->op() == rosbag::OP_CONNECTION) learnConnection(*record);
      if (record->op() == rosbag::OP_MSG_DATA) copyMessage(*record);
    }
  }

  void learnConnection(const Record& record) {
    ros::Header header;
    std::string error;
    if (!header.parse(const_cast<std::uint8_t*>(record.content), record.content_size, error)) {
      return;
    }
    auto fields = boost::make_shared<ros::M_string>(*header.getValues());
    (*fields)["topic"] = record.fields.at(rosbag::TOPIC_FIELD_NAME);
    connections_[record.number(rosbag::CONNECTION_FIELD_NAME)] = fields;
  }

  void copyMessage(const Record& record) {
    const auto connection = connections_.find(record.number(rosbag::CONNECTION_FIELD_NAME));
    if (connection == connections_.end()) return;
    const ros::M_string& fields = *connection->second;
    topic_tools::ShapeShifter message;
    message.morph(fields.at("md5sum"), fields.at("type"), fields.at("message_definition"), "");
    ros::serialization::IStream stream(const_cast<std::uint8_t*>(record.content),
                                       record.content_size);
    message.read(stream);
    const ros::Time time(record.number(rosbag::TIME_FIELD_NAME),
                         record.number(rosbag::TIME_FIELD_NAME, 4));
    bag_.write(fields.at("topic"), time, message, connection->second);
    ++messages_;
  }

  rosbag::Bag& bag_;
  std::map<std::uint32_t, boost::shared_ptr<ros::M_string>> connections_;
  std::size_t messages_ = 0;
};

bool startsLikeABag(std::istream& file) {
  std::string magic;
  return std::getline(file, magic) && magic == "#ROSBAG V2.0";
}

/// Reads the file record by record, so that a bag may be larger than the memory.
class RecordFile {
 public:
  explicit RecordFile(const std::string& path) : file_(path, std::ios::binary) {
    if (!startsLikeABag(file_)) throw std::runtime_error("'" + path + "' is no bag of format 2.0");
  }

  [[nodiscard]] std::optional<Record> next() {
    bytes_.clear();
    if (!append(4)) return std::nullopt;
    const std::uint32_t header_size = readUint32(bytes_.data());
    if (header_size > kLongestRecord || !append(header_size + std::size_t{4})) return std::nullopt;
    const std::uint32_t content_size = readUint32(bytes_.data() + bytes_.size() - 4);
    if (content_size > kLongestRecord) return std::nullopt;
    append(content_size);
    return RecordReader(bytes_.data(), bytes_.size()).next();
  }

 private:
  /// False when the file ends before; what there is is appended.
  bool append(std::size_t count) {
    const std::size_t start = bytes_.size();
    bytes_.resize(start + count);
    file_.read(reinterpret_cast<char*>(bytes_.data()) + start, static_cast<std::streamsize>(count));
    bytes_.resize(start + static_cast<std::size_t>(file_.gcount()));
    return bytes_.size() == start + count;
  }

  std::ifstream file_;
  Bytes bytes_;
};

std::string newTemporaryFile() {
  std::string path = (std::filesystem::temp_directory_path() / "recovered_XXXXXX.bag").string();
  const int file = mkstemps(path.data(), 4);
  if (file < 0) throw std::runtime_error("cannot write '" + path + "': set TMPDIR to a folder");
  ::close(file);
  return path;
}

}  // namespace

bool RecoveredBag::isBag(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return startsLikeABag(file);
}

RecoveredBag::RecoveredBag(const std::string& path) {
  RecordFile file(path);
  path_ = newTemporaryFile();
  try {
    rosbag::Bag copy(path_, rosbag::bagmode::Write);
    copy.setCompression(rosbag::compression::LZ4);
    ChunkCopier copier(copy);
    try {
      while (const std::optional<Record> record = file.next()) {
        if (record->op() == rosbag::OP_CHUNK) copier.copy(*record);
      }
    } catch (const rosbag::BagFormatException&) {
      // The damage begins here; what was copied so far is what can be read.
    } catch (const std::out_of_range&) {
      // Likewise: a record lacks a field.
    }
    messages_ = copier.messages();
    copy.close();
  } catch (const rosbag::BagException& error) {
    std::filesystem::remove(path_);
    throw std::runtime_error("cannot recover '" + path + "': " + error.what());
  }
}

RecoveredBag::~RecoveredBag() {
  std::error_code ignored;
  std::filesystem::remove(path_, ignored);
}

}  // namespace planecloud
