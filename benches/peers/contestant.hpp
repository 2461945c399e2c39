// Protocol of a program timed by `make bench`: it runs jobs by name, requested line by line on standard input.
//
//   time JOB SECONDS  -> {"ns": ...}  nanoseconds of processor time per unit of work: the median over passes
//   result JOB FILE   -> {}           writes the results of the job to FILE, as raw doubles
//
// A pass computes all states once, so that inputs vary as in practice. The Rust program has the same protocol
// (benches/contestant).
#pragma once
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <iostream>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

using Numbers = std::vector<double>;

// prevents the compiler from omitting the computation of `p`
inline void use(const void* p) { asm volatile("" : : "r"(p) : "memory"); }

inline Numbers read_numbers(const std::string& file) {
  std::ifstream in(file, std::ios::binary | std::ios::ate);
  if (!in) throw std::runtime_error("cannot open the file " + file);
  Numbers out(static_cast<size_t>(in.tellg()) / sizeof(double));
  in.seekg(0);
  in.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size() * sizeof(double)));
  return out;
}

// Returns the processor time of this process, ns, which excludes other processes.
inline double processor_time() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e9 * static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec);
}

struct Job {
  std::function<double(double)> time;
  std::function<void(Numbers&)> result;
};

// Creates a job: `pass` does all the work once, which is `units` units; `result` appends the results.
template <class Pass, class Result>
Job job(double units, Pass pass, Result result) {
  auto time = [units, pass](double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    Numbers passes;
    do {
      const double started = processor_time();
      pass();
      passes.push_back((processor_time() - started) / units);
    } while (Clock::now() < end);
    std::sort(passes.begin(), passes.end());
    return passes[passes.size() / 2];
  };
  return {time, result};
}

inline int serve(const std::map<std::string, Job>& jobs) {
  std::cout << "{\"ready\": \"" << __VERSION__ << "\"}" << std::endl;
  for (std::string line; std::getline(std::cin, line);) {
    std::istringstream words(line);
    std::string verb, name, last;
    words >> verb >> name >> last;
    const Job& asked = jobs.at(name);
    if (verb == "time") {
      std::printf("{\"ns\": %.9g}\n", asked.time(std::stod(last)));
    } else {
      Numbers out;
      asked.result(out);
      std::ofstream(last, std::ios::binary)
          .write(reinterpret_cast<const char*>(out.data()), static_cast<std::streamsize>(out.size() * sizeof(double)));
      std::puts("{}");
    }
    std::fflush(stdout);
  }
  return 0;
}
