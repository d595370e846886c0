// Copyright (c) 2026 The Spectral mesh simplification authors.
//
// SPDX-License-Identifier: GPL-3.0-or-later

#ifndef SPECTRAL_EXAMPLES_IO_OUTPUT_FILES_H
#define SPECTRAL_EXAMPLES_IO_OUTPUT_FILES_H

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

// The files that a program writes: either all of them appear, complete, or none.
//
// Each file is written under another name in the folder where it will be. `commit()` renames them at the end; if it is
// never reached, the destructor removes them. Because they are made at the start, a name that cannot be
// written is reported before the work, not after it.
class Output_files
{
public:
  Output_files() = default;
  Output_files(const Output_files&) = delete;
  Output_files& operator=(const Output_files&) = delete;

  ~Output_files()
  {
    std::error_code ignored;
    for(const File& file : m_files)
      std::filesystem::remove(file.temporary, ignored);
    for(auto folder = m_new_folders.rbegin(); folder != m_new_folders.rend(); ++folder)
      std::filesystem::remove(*folder, ignored);
  }

  // The file `path` is an input that no output may replace; call it before `add()`.
  void keep(const std::string& path)
  {
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::absolute(path, error);
    if(!error)
      m_inputs.insert(std::filesystem::weakly_canonical(absolute, error).string());
  }

  // Makes room for the file `path`.
  void add(const std::string& path)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    // Following links replaces the file they lead to, not the link.
    const fs::path target = fs::weakly_canonical(fs::absolute(path), error);
    if(error)
      throw std::runtime_error("cannot write '" + path + "': " + error.message() + ".");
    const fs::path folder = target.parent_path();
    if(!fs::is_directory(folder, error))
      throw std::runtime_error("cannot write '" + path + "': there is no folder '" + folder.string() + "'.");
    if(target.filename().empty() || (fs::exists(target, error) && !fs::is_regular_file(target, error)))
      throw std::runtime_error("cannot write '" + path + "': it is not an ordinary file.");
    if(m_inputs.count(target.string()) > 0)
      throw std::runtime_error("cannot write '" + path + "': it is read as an input, give another name.");
    if(!m_targets.insert(target.string()).second)
      throw std::runtime_error("cannot write '" + path + "' twice: two outputs have the same name.");
    if(fs::exists(target, error) && access(target.c_str(), W_OK) != 0)
      throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno) + ".");

    // The extension stays: CGAL chooses the format by it.
    const fs::path temporary = folder / ("." + target.stem().string() + "." + std::to_string(getpid()) + "-" +
                                         std::to_string(m_targets.size()) + target.extension().string());
    const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if(descriptor < 0)
      throw std::runtime_error("cannot write '" + path + "': " + std::strerror(errno) + ".");
    close(descriptor);
    m_files.push_back({path, target, temporary});
  }

  // The name under which the file `path`, which was added, is to be written meanwhile.
  std::string temporary(const std::string& path) const
  {
    const auto file =
        std::find_if(m_files.begin(), m_files.end(), [&](const File& f) { return f.path == path; });
    if(file == m_files.end())
      throw std::logic_error("the output '" + path + "' was not announced.");
    return file->temporary.string();
  }

  // The file `path`, which was added, will not be written after all.
  void drop(const std::string& path)
  {
    const auto file =
        std::find_if(m_files.begin(), m_files.end(), [&](const File& f) { return f.path == path; });
    if(file == m_files.end())
      return;
    std::error_code ignored;
    std::filesystem::remove(file->temporary, ignored);
    m_files.erase(file);
  }

  // Removes the folders that were made, if nothing is written into them after all.
  void drop_new_folders()
  {
    std::error_code ignored;
    for(auto folder = m_new_folders.rbegin(); folder != m_new_folders.rend(); ++folder)
      std::filesystem::remove(*folder, ignored); // not if there is anything in it
    m_new_folders.clear();
  }

  // Makes the folder `path` unless it exists; it is removed again if nothing is committed.
  void add_folder(const std::string& path)
  {
    std::error_code error;
    if(std::filesystem::is_directory(path, error))
      return;
    if(!std::filesystem::create_directory(path, error)) {
      const std::string reason = error ? error.message() : std::string("there is a file of that name");
      throw std::runtime_error("cannot make the folder '" + path + "': " + reason + ".");
    }
    m_new_folders.push_back(path);
  }

  // Gives the files their names, after their contents have reached the disk.
  void commit()
  {
    for(const File& file : m_files) {
      const int descriptor = open(file.temporary.c_str(), O_RDONLY | O_CLOEXEC);
      const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
      const int reason = errno;
      if(descriptor >= 0)
        close(descriptor);
      if(!synced)
        throw std::runtime_error("cannot write '" + file.path + "': " + std::strerror(reason) + ".");
    }
    for(const File& file : m_files) {
      std::error_code error;
      std::filesystem::rename(file.temporary, file.target, error);
      if(error)
        throw std::runtime_error("cannot write '" + file.path + "': " + error.message() + ".");
    }
    m_files.clear();
    m_new_folders.clear();
  }

private:
  struct File
  {
    std::string path; // as the user wrote it
    std::filesystem::path target, temporary;
  };

  std::vector<File> m_files;
  std::vector<std::filesystem::path> m_new_folders;
  std::set<std::string> m_inputs, m_targets;
};

#endif // SPECTRAL_EXAMPLES_IO_OUTPUT_FILES_H
