#include "tests/core/runtime/jobs/fragile_disk.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <new>
#include <utility>

namespace poise::testing {

// SQLite's file, followed in memory by the one of the disk beneath.
struct FragileFile {
  sqlite3_file base;
  FragileDisk* disk;
  std::string* path;  // nullptr: temporary

  static FragileFile* Of(sqlite3_file* file) { return reinterpret_cast<FragileFile*>(file); }
  static sqlite3_file* Beneath(sqlite3_file* file) {
    return reinterpret_cast<sqlite3_file*>(Of(file) + 1);
  }
  static const sqlite3_io_methods& Methods(sqlite3_file* file) { return *Beneath(file)->pMethods; }

  static int Close(sqlite3_file* file) {
    const int result = Methods(file).xClose(Beneath(file));
    delete Of(file)->path;
    return result;
  }
  static int Read(sqlite3_file* file, void* bytes, int count, sqlite3_int64 offset) {
    return Methods(file).xRead(Beneath(file), bytes, count, offset);
  }
  static int Write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 offset) {
    FragileDisk& disk = *Of(file)->disk;
    if (const int error = disk.write_error_; error != SQLITE_OK) return error;
    if (Of(file)->path != nullptr) {
      disk.OnChange(*Of(file)->path,
                    FragileDisk::Write{
                        offset, {static_cast<const char*>(bytes), static_cast<size_t>(count)}});
    }
    return Methods(file).xWrite(Beneath(file), bytes, count, offset);
  }
  static int Truncate(sqlite3_file* file, sqlite3_int64 size) {
    if (Of(file)->path != nullptr) {
      Of(file)->disk->OnChange(*Of(file)->path, FragileDisk::Truncation{size});
    }
    return Methods(file).xTruncate(Beneath(file), size);
  }
  static int Sync(sqlite3_file* file, int flags) {
    FragileDisk& disk = *Of(file)->disk;
    if (const int error = disk.sync_error_; error != SQLITE_OK) return error;
    const int result = Methods(file).xSync(Beneath(file), flags);
    if (result == SQLITE_OK && Of(file)->path != nullptr) disk.OnSync(*Of(file)->path);
    return result;
  }
  static int FileSize(sqlite3_file* file, sqlite3_int64* size) {
    return Methods(file).xFileSize(Beneath(file), size);
  }
  static int Lock(sqlite3_file* file, int level) {
    return Methods(file).xLock(Beneath(file), level);
  }
  static int Unlock(sqlite3_file* file, int level) {
    return Methods(file).xUnlock(Beneath(file), level);
  }
  static int CheckReservedLock(sqlite3_file* file, int* result) {
    return Methods(file).xCheckReservedLock(Beneath(file), result);
  }
  static int FileControl(sqlite3_file* file, int operation, void* argument) {
    return Methods(file).xFileControl(Beneath(file), operation, argument);
  }
  static int SectorSize(sqlite3_file* file) { return Methods(file).xSectorSize(Beneath(file)); }
  static int DeviceCharacteristics(sqlite3_file* file) {
    return Methods(file).xDeviceCharacteristics(Beneath(file));
  }
  static int ShmMap(sqlite3_file* file, int page, int size, int extend, void volatile** memory) {
    return Methods(file).xShmMap(Beneath(file), page, size, extend, memory);
  }
  static int ShmLock(sqlite3_file* file, int offset, int count, int flags) {
    return Methods(file).xShmLock(Beneath(file), offset, count, flags);
  }
  static void ShmBarrier(sqlite3_file* file) { Methods(file).xShmBarrier(Beneath(file)); }
  static int ShmUnmap(sqlite3_file* file, int remove) {
    return Methods(file).xShmUnmap(Beneath(file), remove);
  }

  static FragileDisk& DiskOf(sqlite3_vfs* vfs) { return *static_cast<FragileDisk*>(vfs->pAppData); }
  static int Open(sqlite3_vfs* vfs, const char* name, sqlite3_file* file, int flags, int* given) {
    static const sqlite3_io_methods methods = {2,
                                               Close,
                                               Read,
                                               Write,
                                               Truncate,
                                               Sync,
                                               FileSize,
                                               Lock,
                                               Unlock,
                                               CheckReservedLock,
                                               FileControl,
                                               SectorSize,
                                               DeviceCharacteristics,
                                               ShmMap,
                                               ShmLock,
                                               ShmBarrier,
                                               ShmUnmap,
                                               nullptr,
                                               nullptr};
    FragileDisk& disk = DiskOf(vfs);
    new (file) FragileFile{{nullptr}, &disk, nullptr};
    const int result = disk.beneath_->xOpen(disk.beneath_, name, Beneath(file), flags, given);
    if (result != SQLITE_OK) return result;
    if (name != nullptr) Of(file)->path = new std::string(name);
    Of(file)->base.pMethods = &methods;
    return SQLITE_OK;
  }
  static int Delete(sqlite3_vfs* vfs, const char* name, int sync_folder) {
    FragileDisk& disk = DiskOf(vfs);
    disk.OnDelete(name);
    return disk.beneath_->xDelete(disk.beneath_, name, sync_folder);
  }
};

FragileDisk::FragileDisk() : vfs_(*sqlite3_vfs_find(nullptr)), beneath_(sqlite3_vfs_find(nullptr)) {
  vfs_.zName = "fragile";
  vfs_.pNext = nullptr;
  vfs_.pAppData = this;
  vfs_.szOsFile = static_cast<int>(sizeof(FragileFile)) + beneath_->szOsFile;
  vfs_.xOpen = FragileFile::Open;
  vfs_.xDelete = FragileFile::Delete;
  sqlite3_vfs_register(&vfs_, 1);
}

FragileDisk::~FragileDisk() {
  StopTakingPart();
  sqlite3_vfs_unregister(&vfs_);
}

void FragileDisk::StopTakingPart() { sqlite3_vfs_register(beneath_, 1); }

std::vector<FragileDisk::Step> FragileDisk::TakeSteps() {
  std::lock_guard lock(mutex_);
  return std::exchange(steps_, {});
}

void FragileDisk::LosePower(const std::filesystem::path& folder, base::Random* random) {
  std::lock_guard lock(mutex_);
  std::filesystem::create_directories(folder);
  for (const auto& [path, contents] : files_) {
    std::string bytes = contents.durable;
    for (const Change& change : contents.pending) {
      if (random != nullptr && random->Uniform() < 0.5) Apply(change, bytes);
    }
    const auto name = std::filesystem::path(path).filename();
    std::ofstream(folder / name, std::ios::binary) << bytes;
  }
}

void FragileDisk::Apply(const Change& change, std::string& bytes) {
  if (const auto* const truncation = std::get_if<Truncation>(&change)) {
    bytes.resize(std::min(bytes.size(), static_cast<size_t>(truncation->size)));
    return;
  }
  const auto& [offset, written] = std::get<Write>(change);
  bytes.resize(std::max(bytes.size(), static_cast<size_t>(offset) + written.size()));
  std::memcpy(bytes.data() + offset, written.data(), written.size());
}

void FragileDisk::OnChange(const std::string& path, Change change) {
  std::lock_guard lock(mutex_);
  files_[path].pending.push_back(std::move(change));
  steps_.push_back({Step::Kind::kWrite, std::filesystem::path(path).filename()});
}

void FragileDisk::OnSync(const std::string& path) {
  std::lock_guard lock(mutex_);
  Contents& contents = files_[path];
  for (const Change& change : std::exchange(contents.pending, {})) Apply(change, contents.durable);
  steps_.push_back({Step::Kind::kSync, std::filesystem::path(path).filename()});
}

void FragileDisk::OnDelete(const std::string& path) {
  std::lock_guard lock(mutex_);
  files_.erase(path);
}

}  // namespace poise::testing
