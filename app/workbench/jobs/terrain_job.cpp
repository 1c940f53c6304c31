// SPDX-License-Identifier: GPL-3.0-or-later
#include "terrain_job.h"

#include <QMetaObject>
#include <exception>

#include "app/models/read_model.h"
#include "trimtab/scene/osg_database.h"
#include "trimtab/terrain/bake/bake.h"
#include "trimtab/terrain/bake/cache.h"
#include "trimtab/terrain/grid/progress.h"
#include "trimtab/terrain/synthetic/sample.h"

namespace trimtab::workbench {

TerrainJob::TerrainJob(QObject* parent) : QObject(parent) {}

TerrainJob::~TerrainJob() {
  stop();
  if (thread_.joinable()) thread_.join();
}

void TerrainJob::stop() {
  if (stop_) *stop_ = true;
  running_ = false;
  ++serial_;
}

void TerrainJob::cancel() {
  if (!running_) return;
  stop();
  emit cancelled();
}

void TerrainJob::open(const std::filesystem::path& source, const std::string& origin) {
  start(source, tr("Opening %1").arg(QString::fromStdString(source.filename().string())),
        [this, source, origin](const terrain::Progress& progress) {
          if (scene::isOsgScene(source)) return scene::openOsgScene(source, origin);
          terrain::BakeOptions asked;
          asked.sources = {source};
          tell(asked);
          return terrain::openOrBake(source, terrain::cacheFolder(), progress,
                                     terrain::BakeOptions{}.trianglesPerNode,
                                     terrain::ObjectsToBake{{}, models::readModel});
        });
}

void TerrainJob::openSample() {
  const std::filesystem::path tif = terrain::cacheFolder() / "sample.tif";
  start(tif, tr("Making the sample terrain"),
        [tif](const terrain::Progress& progress) -> Result<std::shared_ptr<const terrain::Database>> {
          std::error_code error;
          const std::filesystem::path objects = terrain::sampleObjects(tif);
          if (!std::filesystem::exists(tif, error) || !std::filesystem::exists(objects, error)) {
            std::filesystem::create_directories(tif.parent_path(), error);
            terrain::SampleOptions options;
            options.objects = true;
            options.progress = [&progress](double fraction, const std::string& what) {
              return progress(fraction / 2, what);
            };
            if (auto written = terrain::writeSample(tif, options); !written) return written.findings();
          }
          const auto second = [&progress](double fraction, const std::string& what) {
            return progress(0.5 + fraction / 2, what);
          };
          return terrain::openOrBake(tif, terrain::cacheFolder(), second,
                                     terrain::BakeOptions{}.trianglesPerNode,
                                     terrain::ObjectsToBake{objects, models::readModel});
        });
}

void TerrainJob::bake(terrain::BakeOptions options) {
  const std::filesystem::path output = options.output;
  if (!options.readModel) options.readModel = models::readModel;
  start(output, tr("Baking %1").arg(QString::fromStdString(output.filename().string())),
        [this, options = std::move(options)](const terrain::Progress& progress) mutable {
          options.progress = progress;
          tell(options);
          return terrain::bake(options);
        });
}

void TerrainJob::tell(const terrain::BakeOptions& options) {
  Findings notes = terrain::aboutSources(options);
  if (!notes.empty())
    QMetaObject::invokeMethod(
        this, [this, notes = std::move(notes)] { emit found(notes); }, Qt::QueuedConnection);
}

void TerrainJob::start(const std::filesystem::path& source, const QString& what, Work work) {
  stop();
  source_ = source;
  running_ = true;
  stop_ = std::make_shared<std::atomic<bool>>(false);
  const int serial = serial_;
  emit started(what);
  thread_ = std::jthread([this, serial, source, stop = stop_, work = std::move(work),
                          before = std::move(thread_)]() mutable {
    // It may still hold the folder that this one bakes to.
    if (before.joinable()) before.join();
    if (*stop) return;
    const auto post = [this, serial](auto report) {
      QMetaObject::invokeMethod(
          this,
          [this, serial, report] {
            if (serial == serial_) report();
          },
          Qt::QueuedConnection);
    };
    int lastPercent = -1;
    const terrain::Progress progress = [&](double fraction, const std::string& text) {
      if (const int percent = static_cast<int>(fraction * 100); percent != lastPercent) {
        lastPercent = percent;
        post([this, fraction, shown = QString::fromStdString(text)] { emit progressed(fraction, shown); });
      }
      return !*stop;
    };
    const auto finish = [&](Result<std::shared_ptr<const terrain::Database>> result) {
      post([this, result = std::move(result)] {
        running_ = false;
        if (result)
          emit opened(result.value(), result.findings());
        else
          emit failed(result.findings());
      });
    };
    try {
      finish(work(progress));
    } catch (const std::exception& error) {
      finish(Finding{Severity::error, source.string(), "", "terrain that can be read", error.what()});
    }
  });
}

}  // namespace trimtab::workbench
