#ifndef POISE_PROTO_CONVERT_DATA_CONVERT_H_
#define POISE_PROTO_CONVERT_DATA_CONVERT_H_

#include "core/api/data_set.h"
#include "poise/v1/data_service.pb.h"

namespace poise::convert {

v1::DataSet ToProto(const api::DataSet& set);
api::DataSet FromProto(const v1::DataSet& set);

}  // namespace poise::convert

#endif  // POISE_PROTO_CONVERT_DATA_CONVERT_H_
