// SPDX-License-Identifier: Apache-2.0
// Runs the kernel of evaluate.cl through CUDA, for machines whose driver has no OpenCL. Compiled if nvcc is available.
#include <cuda_runtime.h>

#include "telemime/core/errors.h"
#include "telemime/likelihood/gpu/device.h"

namespace telemime::gpu {
namespace kernel {

// Macros of the kernel for CUDA. Products and sums are fused only by FUSED (--fmad=false).
#define GROUP_SIZE 128
#define BAND_PIXELS 7936
#define MOST_VERTICES 1024
#define FN static __device__ __forceinline__
#define KERNEL __global__ void __launch_bounds__(GROUP_SIZE)
#define GLOBAL
#define LOCAL
#define SHARED __shared__
#define THREAD static_cast<int>(threadIdx.x)
#define POSE static_cast<int>(blockIdx.x)
#define SYNCHRONISE __syncthreads()
#define ATOMIC_ADD(address, value) atomicAdd(address, value)
#define ATOMIC_MIN(address, value) atomicMin(address, value)
#define ATOMIC_MAX(address, value) atomicMax(address, value)
#define BITS_OF(x) __float_as_uint(x)
#define FLOAT_OF(x) __uint_as_float(x)
#define FUSED(a, b, c) __fmaf_rn(a, b, c)
#define SINE_COSINE(angle, sine, cosine) sincosf(angle, sine, cosine)
#define FLOOR(x) floorf(x)
#define CEIL(x) ceilf(x)
#define SQRT(x) sqrtf(x)
#define FMIN(a, b) fminf(a, b)
#define FMAX(a, b) fmaxf(a, b)
#define SELECT(m, a, b) ((m) ? (a) : (b))
#define REAL float
#define MASK int
#define NUMBER(x) (x)
#define LESS(a, b) ((a) < (b))
#include "telemime/likelihood/formulas.inc"
#include "telemime/likelihood/gpu/kinematics.cl"
#include "telemime/likelihood/gpu/evaluate.cl"

static_assert(GROUP_SIZE == kGroupSize && BAND_PIXELS == kBandPixels && MOST_VERTICES == kMostVertices);
static_assert(sizeof(Frame) == sizeof(FrameNumbers) && sizeof(PoseCounts) == sizeof(gpu::PoseCounts));

}  // namespace kernel

namespace {

void check(cudaError_t status, const char* what) {
  if (status != cudaSuccess) {
    throw Error(ErrorKind::usage, std::string("CUDA: ") + what + " failed: " + cudaGetErrorString(status),
                "Use the back end simd, or look at the device's driver.");
  }
}

// Memory on the device that grows and is reused.
class Buffer {
 public:
  Buffer() = default;
  Buffer(const Buffer&) = delete;
  Buffer& operator=(const Buffer&) = delete;
  ~Buffer() { cudaFree(data_); }

  template <typename T>
  T* of_size(std::size_t bytes) {
    if (bytes > size_) {
      cudaFree(data_);
      data_ = nullptr;
      size_ = 0;
      check(cudaMalloc(&data_, bytes), "taking memory");
      size_ = bytes;
    }
    return static_cast<T*>(data_);
  }

 private:
  void* data_ = nullptr;
  std::size_t size_ = 0;
};

// A point in time on the device.
class Moment {
 public:
  Moment() { check(cudaEventCreate(&event_), "making an event"); }
  Moment(const Moment&) = delete;
  Moment& operator=(const Moment&) = delete;
  ~Moment() { cudaEventDestroy(event_); }
  void now() { check(cudaEventRecord(event_), "recording an event"); }
  double seconds_since(const Moment& before) const {
    float ms = 0.0F;
    check(cudaEventElapsedTime(&ms, before.event_, event_), "reading the time");
    return 1e-3 * static_cast<double>(ms);
  }

 private:
  cudaEvent_t event_ = nullptr;
};

class CudaDevice final : public Device {
 public:
  DeviceTimes run(const DeviceInput& input, std::span<PoseCounts> counts) override {
    begin_.now();
    const auto* poses = upload<float>(poses_, input.poses);
    const auto* vertices = upload<float>(vertices_, input.vertices);
    const auto* words = upload<std::uint32_t>(words_, input.words);
    const auto* beside = upload<std::int32_t>(beside_, input.beside);
    const auto* frame = upload<FrameNumbers>(frame_, {&input.frame, 1});
    const auto* labels = upload<std::uint8_t>(labels_, input.labels);
    const auto* distance = upload<float>(distance_, input.distance);
    auto* out = counts_.of_size<PoseCounts>(counts.size_bytes());
    uploaded_.now();
    kernel::evaluate_poses<<<static_cast<unsigned>(counts.size()), kGroupSize>>>(
        poses, vertices, words, beside, reinterpret_cast<const kernel::Frame*>(frame), labels, distance,
        reinterpret_cast<kernel::PoseCounts*>(out));
    check(cudaGetLastError(), "starting the kernel");
    counted_.now();
    check(cudaMemcpy(counts.data(), out, counts.size_bytes(), cudaMemcpyDeviceToHost), "reading the counts");
    end_.now();
    check(cudaDeviceSynchronize(), "the kernel");
    return {uploaded_.seconds_since(begin_), counted_.seconds_since(uploaded_), end_.seconds_since(counted_)};
  }

 private:
  template <typename T>
  static const T* upload(Buffer& buffer, std::span<const T> data) {
    T* memory = buffer.of_size<T>(data.size_bytes());
    check(cudaMemcpyAsync(memory, data.data(), data.size_bytes(), cudaMemcpyHostToDevice), "writing");
    return memory;
  }

  Moment begin_, uploaded_, counted_, end_;
  Buffer poses_, vertices_, words_, beside_, frame_, labels_, distance_, counts_;
};

}  // namespace

std::unique_ptr<Device> make_cuda_device() {
  const std::string missing = cuda_missing();
  if (!missing.empty()) {
    throw Error(ErrorKind::usage, "CUDA: " + missing);
  }
  return std::make_unique<CudaDevice>();
}

std::string cuda_missing() {
  int devices = 0;
  const cudaError_t status = cudaGetDeviceCount(&devices);
  if (status != cudaSuccess || devices == 0) {
    return std::string("no NVIDIA GPU with a driver for CUDA is here (") + cudaGetErrorString(status) + ")";
  }
  return {};
}

}  // namespace telemime::gpu
