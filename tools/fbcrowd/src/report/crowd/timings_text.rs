//! The durations of a simulation as text.

use fbcrowd_jobs::timings::Timings;
use fbcrowd_jobs::wording::counted;

/// One figure a line.
pub(crate) fn text(timings: &Timings) -> String {
    format!(
        "time per agent and step  planning {:.2} µs, synthesis {:.2} µs, coupling {:.2} µs\n\
         speed                    {:.1} × real time with {}; one core carries {:.0} agents in real time\n",
        timings.plan_microseconds_per_agent_step,
        timings.synthesis_microseconds_per_agent_step,
        timings.coupling_microseconds_per_agent_step,
        timings.times_real_time,
        counted(timings.threads, "thread", "threads"),
        timings.agents_per_core_in_real_time,
    )
}
