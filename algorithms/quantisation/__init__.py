"""Designing the quantisation of (θ, ρ): how votes spread, what rules follow, what a choice costs."""
