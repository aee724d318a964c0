# Suites that are left out of `ctest -L quick`: each takes more than two seconds alone.
set(ayumi_slow_suites
  cli.Run docs.CommandsOfPage
)
