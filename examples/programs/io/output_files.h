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
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

// A file could not be written.
class Write_error : public std::runtime_error
{
public:
  Write_error(const std::string& path, const std::string& reason)
    : std::runtime_error("cannot write '" + path + "': " + reason)
  {}
};

// Closes a stream to the file that errors call `name`.
inline void finish_writing(std::ofstream& stream, const std::string& name)
{
  stream.close();
  if(!stream)
    throw Write_error(name, "the disk refused it, is it full?");
}

// The files that a program writes: either all of them appear, complete, or none.
//
// Each file is written under another name in the folder where it will be. `commit()` renames them
// at the end; what it is never asked for, the destructor removes. Because they are made at the
// start, a name that cannot be written is reported before the work, not after it.
class Output_files
{
public:
  enum class Input { is_kept, may_be_replaced };

  // The files `inputs`, of which those without a name are none, are not replaced.
  explicit Output_files(const std::vector<std::string>& inputs)
  {
    std::error_code error; // reading them says what is wrong
    for(const std::string& path : inputs)
      if(!path.empty())
        m_inputs.insert(resolved(path, error).string());
  }
  Output_files(const Output_files&) = delete;
  Output_files& operator=(const Output_files&) = delete;

  ~Output_files()
  {
    std::error_code ignored;
    for(const File& file : m_files)
      std::filesystem::remove(file.temporary, ignored);
    for(auto folder = m_new_folders.rbegin(); folder != m_new_folders.rend(); ++folder)
      std::filesystem::remove(*folder, ignored); // not if there is anything in it
  }

  // Makes room for the file `path`.
  void add(const std::string& path, const Input input = Input::is_kept)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    const fs::path target = resolved(path, error);
    if(error)
      throw Write_error(path, error.message() + ".");
    const fs::path folder = target.parent_path();
    if(!fs::is_directory(folder, error))
      throw Write_error(path, "there is no folder '" + folder.string() + "'.");
    if(target.filename().empty() ||
       (fs::exists(target, error) && !fs::is_regular_file(target, error)))
      throw Write_error(path, "it is not an ordinary file.");
    for(const char* const stream : {"/dev/stdout", "/dev/stderr"}) // a shell can make them files
      if(fs::exists(target, error) && fs::equivalent(target, stream, error))
        throw Write_error(path, "the program prints to it, give another name.");
    if(input == Input::is_kept && m_inputs.count(target.string()) > 0)
      throw Write_error(path, "it is read as an input, give another name.");
    if(!m_targets.insert(target.string()).second)
      throw Write_error(path, "it would be written twice, two outputs have the same name.");
    if(fs::exists(target, error) && access(target.c_str(), W_OK) != 0)
      throw Write_error(path, std::strerror(errno) + std::string("."));

    // The extension stays: CGAL chooses the format by it.
    const fs::path temporary =
        folder / ("." + target.stem().string() + "." + std::to_string(getpid()) + "-" +
                  std::to_string(m_targets.size()) + target.extension().string());
    const int descriptor = open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if(descriptor < 0)
      throw Write_error(path, std::strerror(errno) + std::string("."));
    close(descriptor);
    m_files.push_back({path, target, temporary, {}});
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

  // Makes the folder `path` unless it exists; it is removed again if nothing is written into it.
  void add_folder(const std::string& path)
  {
    std::error_code error;
    if(std::filesystem::is_directory(path, error))
      return;
    if(!std::filesystem::create_directory(path, error)) {
      const std::string reason =
          error ? error.message() : std::string("there is a file of that name");
      throw std::runtime_error("cannot make the folder '" + path + "': " + reason + ".");
    }
    m_new_folders.push_back(path);
  }

  // Gives all files their names.
  void commit() { commit(m_files.begin()); }

  // Gives the files `paths` their names; the others may follow later.
  void commit(const std::vector<std::string>& paths)
  {
    commit(std::stable_partition(m_files.begin(), m_files.end(), [&](const File& file) {
      return std::find(paths.begin(), paths.end(), file.path) == paths.end();
    }));
  }

private:
  struct File
  {
    std::string path; // as the user wrote it
    std::filesystem::path target, temporary;
    std::filesystem::path former; // a second name of the file that `target` was
  };

  // Gives the files from `begin` on their names, after their contents have reached the disk. If one
  // of them cannot have it, the files that were there before are back when the error is thrown.
  void commit(const std::vector<File>::iterator begin)
  {
    for(auto file = begin; file != m_files.end(); ++file) {
      const int descriptor = open(file->temporary.c_str(), O_RDONLY | O_CLOEXEC);
      const bool synced = descriptor >= 0 && fsync(descriptor) == 0;
      const int reason = errno;
      if(descriptor >= 0)
        close(descriptor);
      if(!synced)
        throw Write_error(file->path, std::strerror(reason) + std::string("."));
    }
    std::error_code ignored;
    auto file = begin;
    try {
      for(; file != m_files.end(); ++file)
        rename(*file);
    } catch(...) {
      while(file != begin)
        if((--file)->former.empty())
          std::filesystem::remove(file->target, ignored);
        else
          std::filesystem::rename(file->former, file->target, ignored);
      throw;
    }
    for(file = begin; file != m_files.end(); ++file)
      if(!file->former.empty())
        std::filesystem::remove(file->former, ignored);
    m_files.erase(begin, m_files.end());
  }

  // Following links replaces the file they lead to, not the link.
  static std::filesystem::path resolved(const std::string& path, std::error_code& error)
  {
    return std::filesystem::weakly_canonical(std::filesystem::absolute(path, error), error);
  }

  static void rename(File& file)
  {
    namespace fs = std::filesystem;
    std::error_code error;
    if(fs::exists(file.target, error)) {
      // The target never lacks a name: a process that is killed leaves the old file or the new one.
      fs::path former = file.temporary;
      former += ".old";
      fs::create_hard_link(file.target, former, error);
      if(error) // not every file system has them
        fs::copy_file(file.target, former, error);
      if(error)
        throw Write_error(file.path, error.message() + ".");
      file.former = former;
    }
    fs::rename(file.temporary, file.target, error);
    if(!error)
      return;
    std::error_code ignored;
    if(!file.former.empty())
      fs::remove(file.former, ignored);
    throw Write_error(file.path, error.message() + ".");
  }

  std::vector<File> m_files;
  std::vector<std::filesystem::path> m_new_folders;
  std::set<std::string> m_inputs, m_targets;
};

#endif // SPECTRAL_EXAMPLES_IO_OUTPUT_FILES_H
