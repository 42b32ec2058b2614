// The C interface of FMI 3.0.2, declared from the text of the standard (chapters 2.2, 3.2, 4.2), as
// far as an FMU gives it and an importer asks for it.
#ifndef LD_FMU_FMI3_INTERFACE_H
#define LD_FMU_FMI3_INTERFACE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum { fmi3OK, fmi3Warning, fmi3Discard, fmi3Error, fmi3Fatal } fmi3Status;

typedef void (*fmi3Logger)(void *environment, fmi3Status status, const char *category,
                           const char *message);
typedef void (*fmi3IntermediateUpdate)(void *environment, double time, bool set_requested,
                                       bool get_allowed, bool step_finished, bool can_return_early,
                                       bool *return_early, double *return_time);

const char *fmi3GetVersion(void);
fmi3Status fmi3SetDebugLogging(void *instance, bool on, size_t count,
                               const char *const *categories);
void *fmi3InstantiateModelExchange(const char *name, const char *token, const char *resources,
                                   bool visible, bool logging, void *environment, fmi3Logger log);
void *fmi3InstantiateCoSimulation(const char *name, const char *token, const char *resources,
                                  bool visible, bool logging, bool event_mode, bool early_return,
                                  const uint32_t *intermediate, size_t intermediates,
                                  void *environment, fmi3Logger log, fmi3IntermediateUpdate update);
void *fmi3InstantiateScheduledExecution(const char *name, const char *token, const char *resources,
                                        bool visible, bool logging, void *environment,
                                        fmi3Logger log, void (*clock)(void *), void (*lock)(void),
                                        void (*unlock)(void));
void fmi3FreeInstance(void *instance);
fmi3Status fmi3EnterInitializationMode(void *instance, bool tolerance_defined, double tolerance,
                                       double start, bool stop_defined, double stop);
fmi3Status fmi3ExitInitializationMode(void *instance);
fmi3Status fmi3EnterConfigurationMode(void *instance);
fmi3Status fmi3ExitConfigurationMode(void *instance);
fmi3Status fmi3Terminate(void *instance);
fmi3Status fmi3Reset(void *instance);
fmi3Status fmi3GetFloat64(void *instance, const uint32_t *reference, size_t references,
                          double *value, size_t values);
fmi3Status fmi3SetFloat64(void *instance, const uint32_t *reference, size_t references,
                          const double *value, size_t values);
fmi3Status fmi3GetBoolean(void *instance, const uint32_t *reference, size_t references, bool *value,
                          size_t values);
fmi3Status fmi3SetBoolean(void *instance, const uint32_t *reference, size_t references,
                          const bool *value, size_t values);
fmi3Status fmi3GetString(void *instance, const uint32_t *reference, size_t references,
                         const char **value, size_t values);
fmi3Status fmi3SetString(void *instance, const uint32_t *reference, size_t references,
                         const char *const *value, size_t values);
fmi3Status fmi3GetBinary(void *instance, const uint32_t *reference, size_t references, size_t *size,
                         const uint8_t **value, size_t values);
fmi3Status fmi3SetBinary(void *instance, const uint32_t *reference, size_t references,
                         const size_t *size, const uint8_t *const *value, size_t values);
fmi3Status fmi3GetClock(void *instance, const uint32_t *reference, size_t references, bool *value);
fmi3Status fmi3SetClock(void *instance, const uint32_t *reference, size_t references,
                        const bool *value);
fmi3Status fmi3GetNumberOfVariableDependencies(void *instance, uint32_t reference, size_t *count);
fmi3Status fmi3GetVariableDependencies(void *instance, uint32_t dependent, size_t *element,
                                       uint32_t *independent, size_t *of_independent, int *kind,
                                       size_t count);
fmi3Status fmi3DoStep(void *instance, double t, double size, bool no_return, bool *event,
                      bool *terminate, bool *early, double *reached);
fmi3Status fmi3EnterEventMode(void *instance);
fmi3Status fmi3EnterStepMode(void *instance);
fmi3Status fmi3UpdateDiscreteStates(void *instance, bool *again, bool *terminate, bool *nominals,
                                    bool *values, bool *next_defined, double *next);
fmi3Status fmi3EvaluateDiscreteStates(void *instance);
fmi3Status fmi3GetOutputDerivatives(void *instance, const uint32_t *reference, size_t references,
                                    const int32_t *order, double *value, size_t values);
fmi3Status fmi3GetDirectionalDerivative(void *instance, const uint32_t *unknown, size_t unknowns,
                                        const uint32_t *known, size_t knowns, const double *seed,
                                        size_t seeds, double *value, size_t values);
fmi3Status fmi3GetAdjointDerivative(void *instance, const uint32_t *unknown, size_t unknowns,
                                    const uint32_t *known, size_t knowns, const double *seed,
                                    size_t seeds, double *value, size_t values);
fmi3Status fmi3FreeFMUState(void *instance, void **state);
fmi3Status fmi3GetFMUState(void *instance, void **state);
fmi3Status fmi3SetFMUState(void *instance, void *state);
fmi3Status fmi3SerializedFMUStateSize(void *instance, void *state, size_t *size);
fmi3Status fmi3SerializeFMUState(void *instance, void *state, uint8_t *bytes, size_t size);
fmi3Status fmi3DeserializeFMUState(void *instance, const uint8_t *bytes, size_t size, void **state);
fmi3Status fmi3ActivateModelPartition(void *instance, uint32_t clock, double t);
fmi3Status fmi3EnterContinuousTimeMode(void *instance);
fmi3Status fmi3CompletedIntegratorStep(void *instance, bool no_return, bool *event,
                                       bool *terminate);
fmi3Status fmi3SetTime(void *instance, double t);
fmi3Status fmi3SetContinuousStates(void *instance, const double *x, size_t count);
fmi3Status fmi3GetContinuousStateDerivatives(void *instance, double *rate, size_t count);
fmi3Status fmi3GetEventIndicators(void *instance, double *indicator, size_t count);
fmi3Status fmi3GetContinuousStates(void *instance, double *x, size_t count);
fmi3Status fmi3GetNominalsOfContinuousStates(void *instance, double *nominal, size_t count);
fmi3Status fmi3GetNumberOfEventIndicators(void *instance, size_t *count);
fmi3Status fmi3GetNumberOfContinuousStates(void *instance, size_t *count);
fmi3Status fmi3GetFloat32(void *instance, const uint32_t *reference, size_t references,
                          float *value, size_t values);
fmi3Status fmi3SetFloat32(void *instance, const uint32_t *reference, size_t references,
                          const float *value, size_t values);
fmi3Status fmi3GetInt8(void *instance, const uint32_t *reference, size_t references, int8_t *value,
                       size_t values);
fmi3Status fmi3SetInt8(void *instance, const uint32_t *reference, size_t references,
                       const int8_t *value, size_t values);
fmi3Status fmi3GetUInt8(void *instance, const uint32_t *reference, size_t references,
                        uint8_t *value, size_t values);
fmi3Status fmi3SetUInt8(void *instance, const uint32_t *reference, size_t references,
                        const uint8_t *value, size_t values);
fmi3Status fmi3GetInt16(void *instance, const uint32_t *reference, size_t references,
                        int16_t *value, size_t values);
fmi3Status fmi3SetInt16(void *instance, const uint32_t *reference, size_t references,
                        const int16_t *value, size_t values);
fmi3Status fmi3GetUInt16(void *instance, const uint32_t *reference, size_t references,
                         uint16_t *value, size_t values);
fmi3Status fmi3SetUInt16(void *instance, const uint32_t *reference, size_t references,
                         const uint16_t *value, size_t values);
fmi3Status fmi3GetInt32(void *instance, const uint32_t *reference, size_t references,
                        int32_t *value, size_t values);
fmi3Status fmi3SetInt32(void *instance, const uint32_t *reference, size_t references,
                        const int32_t *value, size_t values);
fmi3Status fmi3GetUInt32(void *instance, const uint32_t *reference, size_t references,
                         uint32_t *value, size_t values);
fmi3Status fmi3SetUInt32(void *instance, const uint32_t *reference, size_t references,
                         const uint32_t *value, size_t values);
fmi3Status fmi3GetInt64(void *instance, const uint32_t *reference, size_t references,
                        int64_t *value, size_t values);
fmi3Status fmi3SetInt64(void *instance, const uint32_t *reference, size_t references,
                        const int64_t *value, size_t values);
fmi3Status fmi3GetUInt64(void *instance, const uint32_t *reference, size_t references,
                         uint64_t *value, size_t values);
fmi3Status fmi3SetUInt64(void *instance, const uint32_t *reference, size_t references,
                         const uint64_t *value, size_t values);
fmi3Status fmi3GetIntervalDecimal(void *instance, const uint32_t *reference, size_t references,
                                  double *interval, int *qualifier);
fmi3Status fmi3GetIntervalFraction(void *instance, const uint32_t *reference, size_t references,
                                   uint64_t *counter, uint64_t *resolution, int *qualifier);
fmi3Status fmi3GetShiftDecimal(void *instance, const uint32_t *reference, size_t references,
                               double *shift);
fmi3Status fmi3GetShiftFraction(void *instance, const uint32_t *reference, size_t references,
                                uint64_t *counter, uint64_t *resolution);
fmi3Status fmi3SetIntervalDecimal(void *instance, const uint32_t *reference, size_t references,
                                  const double *interval);
fmi3Status fmi3SetIntervalFraction(void *instance, const uint32_t *reference, size_t references,
                                   const uint64_t *counter, const uint64_t *resolution);
fmi3Status fmi3SetShiftDecimal(void *instance, const uint32_t *reference, size_t references,
                               const double *shift);
fmi3Status fmi3SetShiftFraction(void *instance, const uint32_t *reference, size_t references,
                                const uint64_t *counter, const uint64_t *resolution);

#endif
