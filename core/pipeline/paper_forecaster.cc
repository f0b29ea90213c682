#include "core/pipeline/paper_forecaster.h"

#include "core/push/ldp/forecast_ldp.h"

namespace poise::pipeline {

push::PaperForecaster MakePaperForecaster() { return push::ldp::ForecastTakes; }

}  // namespace poise::pipeline
