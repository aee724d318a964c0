#pragma once
// The files that assimp sees: the mesh itself, and the answers of the owner of the mesh for other
// names. Nothing is opened here.

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>
#include <map>
#include <string>

#include "mesh_import.hpp"

namespace ayumi::mesh_reader {

class CompanionFiles : public Assimp::IOSystem {
 public:
  /// `bytes` has to outlive this object.
  CompanionFiles(const std::string& name, const std::string& bytes, AskFile ask);
  /// The name by which assimp opens the mesh. It is in a folder, since assimp looks for companions
  /// there.
  static std::string path_of(const std::string& name);

  bool Exists(const char* path) const override;
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* path, const char* mode) override;
  void Close(Assimp::IOStream* file) override;

 private:
  const std::string* find(const std::string& path) const;

  std::string path_;
  const std::string& bytes_;
  AskFile ask_;
  mutable std::map<std::string, std::optional<std::string>> companions_;
};

}  // namespace ayumi::mesh_reader
